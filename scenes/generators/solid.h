#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/scene/scene.h"

namespace penumbra::scenes {

/// A closed surface before shading normals are chosen: points are shared by the triangles around
/// them, so that it is watertight by construction. Counter-clockwise seen from outside. Metres.
struct Solid {
  std::vector<glm::dvec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<glm::dvec2, 3>> uvs;  ///< per corner, metres; empty: mapped from a box

  std::uint32_t add_point(const glm::dvec3& point);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  /// Triangles of a simple polygon (ears cut off), which may be concave. `normal` points to the
  /// side from which its points run counter-clockwise.
  void add_polygon(const std::vector<std::uint32_t>& polygon, const glm::dvec3& normal);
};

Solid transformed(Solid solid, const glm::dmat4& matrix);

/// Mesh of one primitive with material 0. Edges whose faces meet at more than `crease` degrees stay
/// sharp, others are smooth. `uv_scale` multiplies metres: 1 / metres covered by one texture.
Mesh to_mesh(const Solid& solid, double crease, double uv_scale = 1.0);

/// Adds a transformed copy of the piece, all of it in `material`; consecutive pieces of one
/// material share a primitive. Mirroring turns triangles round, so that outside stays outside.
void append(Mesh& mesh, const Mesh& piece, const glm::dmat4& transform, std::uint32_t material);

/// The same, each part in the material that it has in the piece.
void append(Mesh& mesh, const Mesh& piece, const glm::dmat4& transform);

/// One primitive for each material, in the order of their first use: fewer draws.
void gather_materials(Mesh& mesh);

/// Normals from the faces around each vertex, weighted by area; vertices at equal positions count
/// as one. Faces more than `crease` degrees apart do not share: vertices are split between them.
void compute_normals(Mesh& mesh, double crease);

}  // namespace penumbra::scenes
