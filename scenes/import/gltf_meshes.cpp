#include <algorithm>
#include <cmath>

#include "renderer/error.h"
#include "scenes/generators/solid.h"
#include "scenes/import/gltf.h"

namespace penumbra::scenes::gltf {
namespace {

int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

/// Indices of separate triangles from strips and fans (glTF 2.0, 3.7.2.1); incomplete ends are cut.
std::vector<std::uint32_t> as_triangles(std::vector<std::uint32_t> indices, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    indices.resize(indices.size() / 3 * 3);
    return indices;
  }
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
      triangles.insert(triangles.end(), {indices[i + 1], indices[i + 2], indices[0]});
    else
      triangles.insert(triangles.end(),
                       {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
  }
  return triangles;
}

std::vector<glm::vec2> read_uvs(const tinygltf::Model& model, int accessor, const TextureUse& use,
                                const std::string& where) {
  const std::vector<float> values = read_floats(model, accessor, 2, where);
  // KHR_texture_transform: translation * rotation * scale, in that order from the left.
  const double c = std::cos(use.rotation), s = std::sin(use.rotation);
  const bool plain =
      use.rotation == 0.0 && use.offset == glm::dvec2(0.0) && use.scale == glm::dvec2(1.0);
  std::vector<glm::vec2> uvs(values.size() / 2);
  for (std::size_t i = 0; i < uvs.size(); ++i) {
    const glm::dvec2 uv(values[2 * i], values[2 * i + 1]);
    const glm::dvec2 scaled = use.scale * uv;
    uvs[i] = plain ? glm::vec2(uv)
                   : glm::vec2(use.offset.x + c * scaled.x + s * scaled.y,
                               use.offset.y - s * scaled.x + c * scaled.y);
  }
  return uvs;
}

/// Whether any place lies beyond the texture's border, rounding aside.
bool leaves_unit_square(const std::vector<glm::vec2>& uvs) {
  constexpr float slack = 1e-3f;
  return std::any_of(uvs.begin(), uvs.end(), [](const glm::vec2& uv) {
    return uv.x < -slack || uv.y < -slack || uv.x > 1.0f + slack || uv.y > 1.0f + slack;
  });
}

std::vector<glm::vec4> read_colors(const tinygltf::Model& model, int accessor,
                                   const std::string& where) {
  const int components = components_of(model, accessor, where);
  if (components != 3 && components != 4)
    throw unreadable(where + " must have 3 or 4 components", where);
  const std::vector<float> values = read_floats(model, accessor, components, where);
  const auto width = static_cast<std::size_t>(components);
  std::vector<glm::vec4> colors(values.size() / width, glm::vec4(1.0f));
  for (std::size_t i = 0; i < colors.size(); ++i)
    for (int c = 0; c < components; ++c)
      colors[i][c] = values[i * width + static_cast<std::size_t>(c)];
  return colors;
}

/// Attributes of one primitive as a mesh without triangles.
Mesh read_vertices(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                   const TextureUse& use, const std::string& where, Notes& notes) {
  Mesh mesh;
  const std::vector<float> positions =
      read_floats(model, attribute(primitive, "POSITION"), 3, where + ".POSITION");
  mesh.positions.resize(positions.size() / 3);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i] = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
  const auto check = [&](std::size_t count, const char* name) {
    if (count != mesh.positions.size())
      throw unreadable(where + "." + name + " and POSITION differ in length", where);
  };
  if (const int accessor = attribute(primitive, "NORMAL"); accessor >= 0) {
    const std::vector<float> normals = read_floats(model, accessor, 3, where + ".NORMAL");
    check(normals.size() / 3, "NORMAL");
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      mesh.normals.emplace_back(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
  }
  const std::string set = "TEXCOORD_" + std::to_string(use.set);
  if (const int accessor = attribute(primitive, set); accessor >= 0) {
    mesh.uvs = read_uvs(model, accessor, use, where + "." + set);
    check(mesh.uvs.size(), set.c_str());
    if (use.textured && !use.repeats && leaves_unit_square(mesh.uvs))
      notes.add(where, ": its texture repeats instead of ending at its border or mirroring");
  } else if (use.textured) {
    notes.add(where, " has no " + set + ": its texture shows one colour");
  }
  if (const int accessor = attribute(primitive, "COLOR_0"); accessor >= 0) {
    mesh.colors = read_colors(model, accessor, where + ".COLOR_0");
    check(mesh.colors.size(), "COLOR_0");
  }
  return mesh;
}

/// Files without normals are shaded flat (glTF 2.0, 3.7.2.1); normals that are no directions are
/// replaced by those of their faces.
void repair_normals(Mesh& mesh, const std::string& where, Notes& notes) {
  if (mesh.normals.empty()) {
    compute_normals(mesh, 0.0);
    return;
  }
  std::vector<glm::vec3> faces;
  for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
    const float length = glm::length(mesh.normals[v]);
    if (std::isfinite(length) && length > 1e-6f) {
      if (std::abs(length - 1.0f) > 1e-3f) mesh.normals[v] /= length;
      continue;
    }
    if (faces.empty()) {
      notes.add(where, ": normals that are no directions were computed anew");
      faces.assign(mesh.positions.size(), glm::vec3(0.0f));
      for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const glm::vec3& a = mesh.positions[mesh.indices[i]];
        const glm::vec3 face = glm::cross(mesh.positions[mesh.indices[i + 1]] - a,
                                          mesh.positions[mesh.indices[i + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) faces[mesh.indices[i + k]] += face;
      }
    }
    const float size = glm::length(faces[v]);
    mesh.normals[v] = std::isfinite(size) && size > 0.0f ? faces[v] / size : glm::vec3(0, 1, 0);
  }
}

/// Adds a mesh's vertices and triangles to another; attributes that one of them lacks are filled
/// in.
void join(Mesh& mesh, Mesh piece) {
  const auto first_vertex = static_cast<std::uint32_t>(mesh.positions.size());
  const auto first_index = static_cast<std::uint32_t>(mesh.indices.size());
  const std::size_t total = mesh.positions.size() + piece.positions.size();
  if (!mesh.uvs.empty() || !piece.uvs.empty()) {
    mesh.uvs.resize(mesh.positions.size(), glm::vec2(0.0f));
    piece.uvs.resize(piece.positions.size(), glm::vec2(0.0f));
    mesh.uvs.insert(mesh.uvs.end(), piece.uvs.begin(), piece.uvs.end());
  }
  if (!mesh.colors.empty() || !piece.colors.empty()) {
    mesh.colors.resize(mesh.positions.size(), glm::vec4(1.0f));
    piece.colors.resize(piece.positions.size(), glm::vec4(1.0f));
    mesh.colors.insert(mesh.colors.end(), piece.colors.begin(), piece.colors.end());
  }
  mesh.positions.reserve(total);
  mesh.positions.insert(mesh.positions.end(), piece.positions.begin(), piece.positions.end());
  mesh.normals.insert(mesh.normals.end(), piece.normals.begin(), piece.normals.end());
  mesh.indices.reserve(mesh.indices.size() + piece.indices.size());
  for (const std::uint32_t index : piece.indices) mesh.indices.push_back(first_vertex + index);
  for (Primitive primitive : piece.primitives) {
    primitive.first_index += first_index;
    mesh.primitives.push_back(primitive);
  }
}

bool is_surface(const tinygltf::Primitive& primitive, const std::string& where, Notes& notes) {
  if (primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN)
    return true;
  if (primitive.mode < -1 || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
    throw unreadable(where + ".mode is none of glTF: " + std::to_string(primitive.mode), where);
  if (primitive.mode == -1) return true;
  notes.add(where, " consists of points or lines: it is left out");
  return false;
}

Mesh read_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                    const std::vector<TextureUse>& uses, const std::string& where, Notes& notes) {
  if (primitive.material >= static_cast<int>(model.materials.size()) || primitive.material < -1)
    throw unreadable(where + ".material names no material", where);
  const auto material = primitive.material < 0 ? model.materials.size()
                                               : static_cast<std::size_t>(primitive.material);
  if (attribute(primitive, "POSITION") < 0) {
    notes.add(where, " has no positions: it is left out");
    return {};
  }
  Mesh mesh = read_vertices(model, primitive, uses[material], where, notes);
  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0) {
    indices = read_indices(model, primitive.indices, where + ".indices");
  } else {
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) indices.push_back(i);
  }
  const int mode = primitive.mode == -1 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  mesh.indices = as_triangles(std::move(indices), mode);
  for (const std::uint32_t index : mesh.indices)
    if (index >= mesh.positions.size())
      throw unreadable(where + ".indices has the vertex " + std::to_string(index) + " of " +
                           std::to_string(mesh.positions.size()),
                       where);
  mesh.primitives = {
      {0, static_cast<std::uint32_t>(mesh.indices.size()), static_cast<std::uint32_t>(material)}};
  repair_normals(mesh, where, notes);
  return mesh;
}

/// Whether two primitives read the same vertices, which then are stored once.
bool share_vertices(const tinygltf::Primitive& a, const tinygltf::Primitive& b,
                    const std::vector<TextureUse>& uses) {
  const auto use_of = [&](const tinygltf::Primitive& p) {
    return p.material < 0 ? uses.back() : uses[static_cast<std::size_t>(p.material)];
  };
  return a.attributes == b.attributes && attribute(a, "NORMAL") >= 0 && a.indices >= 0 &&
         b.indices >= 0 && use_of(a) == use_of(b);
}

}  // namespace

void read_meshes(const tinygltf::Model& model, const std::vector<TextureUse>& uses, Scene& scene,
                 Notes& notes) {
  std::size_t corners = 0;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    const tinygltf::Mesh& from = model.meshes[m];
    Mesh mesh;
    const tinygltf::Primitive* before = nullptr;
    for (std::size_t p = 0; p < from.primitives.size(); ++p) {
      const tinygltf::Primitive& primitive = from.primitives[p];
      const std::string where = element("meshes", m, from.name) + "." + element("primitives", p);
      if (primitive.extensions.count("KHR_draco_mesh_compression") != 0 &&
          attribute(primitive, "POSITION") < 0)
        throw unreadable(where + " is compressed by KHR_draco_mesh_compression", where);
      if (!primitive.targets.empty() && p == 0)
        notes.add(where, ": its morph targets are left out");
      if (!is_surface(primitive, where, notes)) continue;
      Mesh piece = read_primitive(model, primitive, uses, where, notes);
      if (piece.indices.empty()) continue;
      corners += piece.indices.size();
      if (corners > max_corners) throw unreadable("the file has too many triangles", where);
      if (before != nullptr && share_vertices(*before, primitive, uses)) {
        const auto first =
            static_cast<std::uint32_t>(mesh.positions.size() - piece.positions.size());
        const auto first_index = static_cast<std::uint32_t>(mesh.indices.size());
        for (const std::uint32_t index : piece.indices) mesh.indices.push_back(first + index);
        mesh.primitives.push_back(
            {first_index, piece.primitives[0].index_count, piece.primitives[0].material});
      } else {
        join(mesh, std::move(piece));
        before = &primitive;
      }
    }
    mesh.name = from.name;
    scene.meshes.push_back(std::move(mesh));
  }
}

}  // namespace penumbra::scenes::gltf
