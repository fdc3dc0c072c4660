#include "scenes/generators/solid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "renderer/error.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {
namespace {

using SolidCorner = std::tuple<std::uint32_t, float, float, float, float, float>;

glm::dvec3 face_vector(const Solid& solid, const std::array<std::uint32_t, 3>& triangle) {
  const glm::dvec3& a = solid.points[triangle[0]];
  return glm::cross(solid.points[triangle[1]] - a, solid.points[triangle[2]] - a);
}

/// Maps a point along the axis in which the face looks most, so that texture density is even. The
/// horizontal direction of walls runs along the wall.
glm::dvec2 box_uv(const glm::dvec3& point, const glm::dvec3& face) {
  const glm::dvec3 size = glm::abs(face);
  if (size.y >= size.x && size.y >= size.z) return {point.x, point.z};
  if (size.x >= size.z) return {face.x > 0.0 ? -point.z : point.z, -point.y};
  return {face.z > 0.0 ? point.x : -point.x, -point.y};
}

double cross2(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Whether p lies in the triangle or on its edges.
bool inside(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return cross2(b - a, p - a) >= 0.0 && cross2(c - b, p - b) >= 0.0 && cross2(a - c, p - c) >= 0.0;
}

}  // namespace

std::uint32_t Solid::add_point(const glm::dvec3& point) {
  points.push_back(point);
  return static_cast<std::uint32_t>(points.size() - 1);
}

void Solid::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  triangles.push_back({a, b, c});
}

void Solid::add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  triangles.push_back({a, b, c});
  triangles.push_back({a, c, d});
}

void Solid::add_polygon(const std::vector<std::uint32_t>& polygon, const glm::dvec3& normal) {
  // Flatten along the normal, keeping the winding.
  const glm::dvec3 n = glm::normalize(normal);
  const glm::dvec3 helper = std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, n));
  const glm::dvec3 y = glm::cross(n, x);
  const auto flat = [&](std::uint32_t i) {
    return glm::dvec2(glm::dot(points[i], x), glm::dot(points[i], y));
  };
  std::vector<std::uint32_t> rest = polygon;
  while (rest.size() > 3) {
    // Among the ears take the one whose cut is shortest: it avoids slivers.
    std::size_t best = rest.size();
    double best_length = 0.0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const std::size_t before = (i + rest.size() - 1) % rest.size();
      const std::size_t after = (i + 1) % rest.size();
      const glm::dvec2 a = flat(rest[before]), b = flat(rest[i]), c = flat(rest[after]);
      if (cross2(b - a, c - b) <= 1e-12) continue;
      bool ear = true;
      for (const std::uint32_t other : rest)
        if (other != rest[before] && other != rest[i] && other != rest[after])
          ear = ear && !inside(flat(other), a, b, c);
      const double length = glm::dot(c - a, c - a);
      if (ear && (best == rest.size() || length < best_length)) {
        best = i;
        best_length = length;
      }
    }
    if (best == rest.size()) throw bad_value("polygon", "a polygon crosses itself");
    add_triangle(rest[(best + rest.size() - 1) % rest.size()], rest[best],
                 rest[(best + 1) % rest.size()]);
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
  }
  add_triangle(rest[0], rest[1], rest[2]);
}

Solid transformed(Solid solid, const glm::dmat4& matrix) {
  for (glm::dvec3& point : solid.points) point = glm::dvec3(matrix * glm::dvec4(point, 1.0));
  if (glm::determinant(glm::dmat3(matrix)) < 0.0) {
    for (auto& triangle : solid.triangles) std::swap(triangle[1], triangle[2]);
    for (auto& uv : solid.uvs) std::swap(uv[1], uv[2]);
  }
  return solid;
}

Mesh to_mesh(const Solid& solid, double crease, double uv_scale) {
  std::vector<std::vector<std::uint32_t>> around(solid.points.size());
  std::vector<glm::dvec3> faces;
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    faces.push_back(face_vector(solid, solid.triangles[t]));
    for (const std::uint32_t point : solid.triangles[t]) around[point].push_back(t);
  }
  const double least_cosine = circle(crease).x;
  Mesh mesh;
  std::map<SolidCorner, std::uint32_t> known;
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const glm::dvec3 own = glm::normalize(faces[t]);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t point = solid.triangles[t][static_cast<std::size_t>(k)];
      glm::dvec3 sum(0.0);
      for (const std::uint32_t other : around[point])
        if (glm::dot(glm::normalize(faces[other]), own) >= least_cosine) sum += faces[other];
      const glm::vec3 normal(glm::normalize(sum));
      const glm::vec2 uv(uv_scale * (solid.uvs.empty()
                                         ? box_uv(solid.points[point], own)
                                         : solid.uvs[t][static_cast<std::size_t>(k)]));
      const auto [entry, added] =
          known.try_emplace(SolidCorner{point, normal.x, normal.y, normal.z, uv.x, uv.y},
                            static_cast<std::uint32_t>(mesh.positions.size()));
      if (added) {
        mesh.positions.emplace_back(solid.points[point]);
        mesh.normals.push_back(normal);
        mesh.uvs.push_back(uv);
      }
      mesh.indices.push_back(entry->second);
    }
  }
  mesh.primitives = {{0, static_cast<std::uint32_t>(mesh.indices.size()), 0}};
  return mesh;
}

void append(Mesh& mesh, const Mesh& piece, const glm::dmat4& transform) {
  const auto first_vertex = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::dmat3 linear(transform);
  const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(linear));
  const bool mirrored = glm::determinant(linear) < 0.0;
  for (const glm::vec3& position : piece.positions)
    mesh.positions.emplace_back(transform * glm::dvec4(glm::dvec3(position), 1.0));
  for (const glm::vec3& normal : piece.normals)
    mesh.normals.emplace_back(glm::normalize(normal_matrix * glm::dvec3(normal)));
  mesh.uvs.insert(mesh.uvs.end(), piece.uvs.begin(), piece.uvs.end());
  for (const Primitive& part : piece.primitives) {
    const auto first_index = static_cast<std::uint32_t>(mesh.indices.size());
    for (std::size_t i = part.first_index; i < part.first_index + part.index_count; i += 3) {
      mesh.indices.push_back(first_vertex + piece.indices[i]);
      mesh.indices.push_back(first_vertex + piece.indices[i + (mirrored ? 2 : 1)]);
      mesh.indices.push_back(first_vertex + piece.indices[i + (mirrored ? 1 : 2)]);
    }
    if (!mesh.primitives.empty() && mesh.primitives.back().material == part.material)
      mesh.primitives.back().index_count += part.index_count;
    else
      mesh.primitives.push_back({first_index, part.index_count, part.material});
  }
}

void append(Mesh& mesh, const Mesh& piece, const glm::dmat4& transform, std::uint32_t material) {
  Mesh one = piece;
  one.primitives = {{0, static_cast<std::uint32_t>(piece.indices.size()), material}};
  append(mesh, one, transform);
}

void gather_materials(Mesh& mesh) {
  std::vector<Primitive> gathered;
  std::vector<std::uint32_t> indices;
  for (const Primitive& first : mesh.primitives) {
    const auto is_same = [&](const Primitive& part) { return part.material == first.material; };
    if (std::any_of(gathered.begin(), gathered.end(), is_same)) continue;
    const auto start = static_cast<std::uint32_t>(indices.size());
    for (const Primitive& part : mesh.primitives)
      if (is_same(part))
        indices.insert(indices.end(), mesh.indices.begin() + part.first_index,
                       mesh.indices.begin() + part.first_index + part.index_count);
    gathered.push_back({start, static_cast<std::uint32_t>(indices.size()) - start, first.material});
  }
  mesh.indices = std::move(indices);
  mesh.primitives = std::move(gathered);
}

}  // namespace penumbra::scenes
