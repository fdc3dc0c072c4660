#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "renderer/error.h"
#include "scenes/generators/solid.h"
#include "scenes/import/import.h"
#include "scenes/import/local_origin.h"
#include "scenes/import/obj.h"
#include "scenes/import/polygon.h"
#include "scenes/text.h"

namespace penumbra::scenes {
namespace fs = std::filesystem;
namespace {

using obj::Corner;

struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    std::size_t hash = 0;
    for (const int index : {corner.position, corner.uv, corner.normal})
      hash = (hash ^ (hash >> 29)) * 0x9E3779B97F4A7C15ull + static_cast<std::size_t>(index + 1);
    return hash ^ (hash >> 32);
  }
};

/// Corners of a face: one that crosses itself everywhere takes their square in time and memory.
constexpr std::size_t max_polygon = 10'000;

/// Mean of a list's values at up to four corners.
template <class T>
T mix(const std::vector<T>& values, const std::vector<Corner>& corners, const CornerShares& shares,
      int Corner::*index) {
  T sum(0.0);
  for (const auto& [corner, share] : shares)
    if (share != 0.0)
      sum += values[static_cast<std::size_t>(corners[corner].*index)] *
             static_cast<typename T::value_type>(share);
  return sum;
}

/// Turns the faces of a shape into triangles.
class MeshBuilder {
 public:
  MeshBuilder(obj::File& file_, Notes& notes_) : file(file_), notes(notes_) {}

  Mesh build(const obj::Shape& shape, glm::dvec3& origin, const std::string& where) {
    by_material.clear();
    for (const obj::Face& face : shape.faces) add_face(face, where);
    std::vector<glm::dvec3> points;
    for (const auto& [material, corners] : by_material)
      for (const Corner& corner : corners) points.push_back(position(corner));
    origin = local_origin(points);
    return mesh_of(shape.name, origin);
  }

 private:
  glm::dvec3 position(const Corner& corner) const {
    return file.positions[static_cast<std::size_t>(corner.position)];
  }

  void add_face(const obj::Face& face, const std::string& where) {
    if (face.count > max_polygon) {
      notes.add(where, " has a face of more than 10000 corners: it is left out");
      return;
    }
    const auto begin = file.corners.begin() + static_cast<std::ptrdiff_t>(face.first);
    std::vector<Corner> corners(begin, begin + static_cast<std::ptrdiff_t>(face.count));
    std::vector<glm::dvec3> polygon;
    for (const Corner& corner : corners) polygon.push_back(position(corner));
    std::vector<Corner> added;
    const Triangulation triangles = triangulate(
        polygon, [&](const CornerShares& shares) { corners.push_back(crossing(corners, shares)); });
    if (triangles.crosses_itself) notes.add(where, " has a face whose edges cross");
    std::vector<Corner>& list = by_material[face.material];
    for (const std::uint32_t corner : triangles.corners) list.push_back(corners[corner]);
  }

  /// A corner where edges of a face cross, with what its neighbours have.
  Corner crossing(const std::vector<Corner>& corners, const CornerShares& shares) {
    Corner corner{static_cast<int>(file.positions.size()), -1, -1};
    bool uvs = true, normals = true;
    for (const auto& [number, share] : shares) {
      uvs = uvs && (share == 0.0 || corners[number].uv >= 0);
      normals = normals && (share == 0.0 || corners[number].normal >= 0);
    }
    if (!file.colors.empty())
      file.colors.push_back(mix(file.colors, corners, shares, &Corner::position));
    file.positions.push_back(mix(file.positions, corners, shares, &Corner::position));
    if (uvs) {
      corner.uv = static_cast<int>(file.uvs.size());
      file.uvs.push_back(mix(file.uvs, corners, shares, &Corner::uv));
    }
    if (normals) {
      corner.normal = static_cast<int>(file.normals.size());
      file.normals.push_back(mix(file.normals, corners, shares, &Corner::normal));
    }
    return corner;
  }

  std::uint32_t vertex(const Corner& corner, const glm::dvec3& origin, Mesh& mesh) {
    const auto [entry, added] =
        known.try_emplace(corner, static_cast<std::uint32_t>(mesh.positions.size()));
    if (!added) return entry->second;
    mesh.positions.emplace_back(position(corner) - origin);
    glm::dvec3 normal(0.0);
    if (corner.normal >= 0) normal = file.normals[static_cast<std::size_t>(corner.normal)];
    const double length = glm::length(normal);
    has_normals = has_normals && std::isfinite(length) && length > 1e-6;
    mesh.normals.emplace_back(length > 1e-6 ? normal / length : normal);
    glm::dvec2 uv(0.0, 1.0);
    if (corner.uv >= 0) uv = file.uvs[static_cast<std::size_t>(corner.uv)];
    has_uvs = has_uvs || corner.uv >= 0;
    // OBJ counts v from below.
    mesh.uvs.emplace_back(uv.x, 1.0 - uv.y);
    if (!file.colors.empty())
      mesh.colors.emplace_back(file.colors[static_cast<std::size_t>(corner.position)], 1.0f);
    return entry->second;
  }

  Mesh mesh_of(const std::string& name, const glm::dvec3& origin) {
    known.clear();
    has_normals = true;
    has_uvs = false;
    Mesh mesh;
    mesh.name = name;
    for (const auto& [material, corners] : by_material) {
      if (corners.empty()) continue;
      mesh.primitives.push_back({static_cast<std::uint32_t>(mesh.indices.size()),
                                 static_cast<std::uint32_t>(corners.size()),
                                 static_cast<std::uint32_t>(material)});
      for (const Corner& corner : corners) mesh.indices.push_back(vertex(corner, origin, mesh));
    }
    if (!has_uvs) mesh.uvs.clear();
    if (!has_normals) compute_normals(mesh, 40.0);
    return mesh;
  }

  obj::File& file;
  Notes& notes;
  std::map<int, std::vector<Corner>> by_material;
  std::unordered_map<Corner, std::uint32_t, CornerHash> known;
  bool has_normals = true;
  bool has_uvs = false;
};

std::string place_text(const glm::dvec3& place) {
  return "(" + std::to_string(std::llround(place.x)) + ", " +
         std::to_string(std::llround(place.y)) + ", " + std::to_string(std::llround(place.z)) + ")";
}

}  // namespace

Scene import_obj(const fs::path& file, bool complete) {
  Scene scene;
  Notes notes;
  scene.id = scene.title = file.stem().string();
  obj::File read = obj::read_file(read_bytes(file), notes);
  SideFiles files(file.parent_path(), notes);
  obj::read_materials(read, files, scene, notes);
  // Faces before the first usemtl have the grey one at the end.
  for (obj::Shape& shape : read.shapes)
    for (obj::Face& face : shape.faces)
      if (face.material < 0) face.material = static_cast<int>(scene.materials.size()) - 1;
  MeshBuilder builder(read, notes);
  for (std::size_t i = 0; i < read.shapes.size(); ++i) {
    if (read.shapes[i].faces.empty()) continue;
    const std::string where =
        "shape " + std::to_string(i + 1) + " " + in_quotes(read.shapes[i].name);
    glm::dvec3 origin(0.0);
    Mesh mesh = builder.build(read.shapes[i], origin, where);
    if (mesh.indices.empty()) continue;
    if (origin != glm::dvec3(0.0))
      notes.add(where, " is counted from " + place_text(origin) +
                           " metres, so that it keeps its accuracy far from the origin");
    glm::dmat4 place(1.0);
    place[3] = glm::dvec4(origin, 1.0);
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({scene.meshes.back().name,
                               static_cast<std::uint32_t>(scene.meshes.size() - 1), place, true});
  }
  if (scene.instances.empty()) throw unreadable("the file has no faces to draw");
  notes.write_to(scene.notes);
  if (complete) complete_import(scene);
  return scene;
}

}  // namespace penumbra::scenes
