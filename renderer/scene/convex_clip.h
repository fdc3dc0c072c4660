#pragma once

#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/scene/scene.h"

namespace penumbra {

/// A half-space: dot(side, (p, 1)) is not negative within.
using HalfSpace = glm::dvec4;

/// The part of a convex polygon inside a half-space (Sutherland and Hodgman 1974).
std::vector<glm::dvec3> clip(const std::vector<glm::dvec3>& polygon, const HalfSpace& side);

/// Calls `visit` with every corner of the box's six faces, each clipped to all of `sides`. Together
/// with corners of the half-spaces' own body that lie within the box, these span their common part.
void visit_clipped_corners(const Bounds& box, std::span<const HalfSpace> sides,
                           const std::function<void(const glm::dvec3&)>& visit);

/// Box around the part of `box` inside convex `sides` whose own corners are given; may be empty.
Bounds common_part(const Bounds& box, std::span<const HalfSpace> sides,
                   std::span<const glm::dvec3> corners);

/// Corners of the body that half-spaces enclose; those at infinity are left out. By trying every
/// three of them: for tens, not for hundreds.
std::vector<glm::dvec3> body_corners(std::span<const HalfSpace> sides);

/// The half-spaces x >= -w, x <= w, y >= -w, y <= w of a clip matrix, in front of its eye.
std::array<HalfSpace, 4> side_planes(const glm::dmat4& clip_from_world);

/// The half-space z <= w: beyond the near plane, where depth is reversed.
HalfSpace near_plane(const glm::dmat4& clip_from_world);

/// False only if the box lies wholly outside one of the half-spaces.
bool may_touch(const Bounds& box, std::span<const HalfSpace> sides);
/// The same of a sphere.
bool may_touch(const glm::dvec3& center, double radius, std::span<const HalfSpace> sides);

bool contains(const Bounds& box, const glm::dvec3& point);

}  // namespace penumbra
