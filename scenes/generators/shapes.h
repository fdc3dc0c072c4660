#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scenes/generators/solid.h"

namespace penumbra::scenes {

/// Closed shapes in metres, Y up. Where nothing else is said, uvs come from a box around the shape.

Solid box(const glm::dvec3& low, const glm::dvec3& high);

/// Box with edges of `radius`, rounded in `segments` steps (1: a chamfer; 108 triangles).
Solid rounded_box(const glm::dvec3& low, const glm::dvec3& high, double radius, int segments);

/// Turns a profile of (radius, height) around the vertical axis. The profile goes upwards on the
/// outside; radius 0 at an end closes it there, any other end is closed with a disc. uvs: arc
/// length around at the widest radius, length along the profile.
Solid lathe(const std::vector<glm::dvec2>& profile, int slices);

/// As lathe, but the profile is a closed loop (counter-clockwise in (radius, height)): a ring.
Solid ring(const std::vector<glm::dvec2>& loop, int slices);

Solid sphere(double radius, int slices, int stacks);                               ///< centre at 0
Solid cylinder(double radius_low, double radius_high, double height, int slices);  ///< base at 0
Solid torus(double radius, double tube, int slices, int sides);  ///< lies in the plane y = 0

/// Closed tube around the trefoil knot, within a box of about 1 m: it shadows itself. 2 * steps *
/// sides triangles.
Solid trefoil(double tube, int steps, int sides);

/// Tube of changing radius along a path, closed with discs. One radius per point.
Solid tube(const std::vector<glm::dvec3>& path, const std::vector<double>& radii, int sides);

/// Polygon in (x, y), counter-clockwise, swept from z = -depth / 2 to depth / 2.
Solid extrude(const std::vector<glm::dvec2>& polygon, double depth);

/// Skin over rings of equally many points, the first and last closed flat. Each ring is
/// counter-clockwise seen from where the rings go to.
Solid loft(const std::vector<std::vector<glm::dvec3>>& rings);

/// Plate in x and y with its front at z = thickness / 2: the cells between the given lines, less
/// the holes, each a cell {column, row}. Holes may touch along sides but not at corners only.
Solid plate(const std::vector<double>& xs, const std::vector<double>& ys,
            const std::vector<std::array<int, 2>>& holes, double thickness);

/// Square bar between two points; `up` says where its upper side looks.
Solid bar(const glm::dvec3& from, const glm::dvec3& to, double width, double height,
          const glm::dvec3& up = {0.0, 1.0, 0.0});

/// Sphere of radius 1 with seeded bumps, for rocks: `roughness` is the greatest change of radius.
Solid boulder(std::uint32_t seed, double roughness, int slices, int stacks);

/// Block whose upper side is a grid of heights, row by row in z (`columns` heights along x each);
/// its lower side is flat at `bottom`.
Solid height_field(const glm::dvec2& low, const glm::dvec2& high, int columns,
                   const std::vector<double>& heights, double bottom);

}  // namespace penumbra::scenes
