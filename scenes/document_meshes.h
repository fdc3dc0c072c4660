#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace penumbra::scenes {

/// Names of the shapes that a mesh of a document may be generated from, in a stable order.
std::vector<std::string> mesh_generators();

/// A mesh by its arrays or by a generator; `material_of` turns a number or name into an index.
/// `origin` becomes the place that positions are counted from: zero, unless they do not fit into
/// floats otherwise (local_origin).
Mesh read_mesh(
    const nlohmann::json& value, const std::string& path,
    const std::function<std::uint32_t(const nlohmann::json&, const std::string&)>& material_of,
    glm::dvec3& origin);

/// The mesh by its arrays.
nlohmann::json write_mesh(const Mesh& mesh);

}  // namespace penumbra::scenes
