#include "scenes/generators/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/scenes/watertight.h"

namespace penumbra::scenes {
namespace {

using std::numbers::pi;

struct Case {
  const char* name;
  std::function<Solid()> make;
  double volume;     ///< cubic metres, from the textbook's formula
  double tolerance;  ///< relative: facets lie inside round shapes
};

// L-shaped polygon of area 3.
const std::vector<glm::dvec2> corner_shape = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};

const std::vector<Case> cases = {
    {"box",
     [] {
       return box({-1, 0, 2}, {1, 3, 4});
     },
     12.0, 1e-6},
    {"rounded box",
     [] {
       return rounded_box({0, 0, 0}, {2, 2, 2}, 0.5, 16);
     },
     // core, six slabs, twelve quarter cylinders, eight eighths of a ball
     1.0 + 6 * 0.5 + 12 * 0.25 * pi * 0.25 + 4.0 / 3.0 * pi * 0.125, 2e-3},
    {"sphere", [] { return sphere(2.0, 96, 48); }, 4.0 / 3.0 * pi * 8.0, 5e-3},
    {"cylinder", [] { return cylinder(0.5, 0.5, 3.0, 96); }, pi * 0.25 * 3.0, 2e-3},
    {"cone", [] { return cylinder(1.0, 0.0, 3.0, 96); }, pi, 2e-3},
    {"frustum", [] { return cylinder(2.0, 1.0, 3.0, 96); }, pi*(4.0 + 2.0 + 1.0), 2e-3},
    {"torus", [] { return torus(2.0, 0.5, 128, 64); }, 2.0 * pi* pi * 2.0 * 0.25, 5e-3},
    {"tube",
     [] {
       return tube({{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {0.3, 0.3, 0.3}, 96);
     },
     pi * 0.09 * 2.0, 2e-3},
    {"extruded corner", [] { return extrude(corner_shape, 2.0); }, 6.0, 1e-6},
    {"height field",
     [] {
       return height_field({0, 0}, {2, 2}, 3, std::vector<double>(9, 1.5), -0.5);
     },
     8.0, 1e-6},
    // Length of the knot: integral of |derivative|, by the periodic trapezoid rule, is 4.4681
    // m.
    {"trefoil", [] { return trefoil(0.05, 400, 48); }, 4.4681 * pi * 0.0025, 5e-3}};

TEST(Shapes, EncloseTheVolumeOfTheirFormula) {
  for (const Case& shape : cases) {
    const Mesh mesh = to_mesh(shape.make(), 30.0);
    EXPECT_EQ(test::leak_of(mesh), "") << shape.name;
    EXPECT_NEAR(test::volume_of(mesh), shape.volume, shape.tolerance * shape.volume) << shape.name;
  }
}

TEST(Shapes, StayClosedAndOutwardWhenMirrored) {
  for (const Case& shape : cases) {
    glm::dmat4 mirror(1.0);
    mirror[0].x = -1.0;
    Mesh mesh;
    append(mesh, to_mesh(shape.make(), 30.0), mirror, 0);
    EXPECT_EQ(test::leak_of(mesh), "") << shape.name;
    EXPECT_GT(test::volume_of(mesh), 0.0) << shape.name;
    EXPECT_GT(test::volume_of(to_mesh(transformed(shape.make(), mirror), 30.0)), 0.0) << shape.name;
  }
}

TEST(Shapes, HaveUnitNormalsThatLookOutwards) {
  const Mesh mesh = to_mesh(sphere(2.0, 64, 32), 60.0);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    EXPECT_GT(glm::dot(mesh.normals[i], mesh.positions[i] / 2.0f), 0.995f);
}

TEST(Shapes, KeepEdgesBeyondTheCreaseSharp) {
  // Each of a cube's 24 corners of faces keeps its face's normal; smoothed, only its 8 points
  // remain (with one uv per face they still are 24 vertices).
  const Mesh sharp = to_mesh(box({0, 0, 0}, {1, 1, 1}), 45.0);
  for (const glm::vec3& normal : sharp.normals)
    EXPECT_EQ(std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z), 1.0f);
  const Mesh smooth = to_mesh(box({0, 0, 0}, {1, 1, 1}), 100.0);
  for (const glm::vec3& normal : smooth.normals)
    EXPECT_GT(std::min({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)}), 0.3f);
}

TEST(Shapes, LayTexturesInMetres) {
  // The upper side of a 3 x 2 m box spans 3 x 2 units of uv, halved by a scale of 1/2.
  const Mesh mesh = to_mesh(box({0, 0, 0}, {3, 1, 2}), 45.0, 0.5);
  glm::vec2 low(1e9f), high(-1e9f);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (mesh.normals[i].y > 0.5f) {
      low = glm::min(low, mesh.uvs[i]);
      high = glm::max(high, mesh.uvs[i]);
    }
  EXPECT_FLOAT_EQ(high.x - low.x, 1.5f);
  EXPECT_FLOAT_EQ(high.y - low.y, 1.0f);
}

}  // namespace
}  // namespace penumbra::scenes
