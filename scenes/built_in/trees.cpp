#include <vector>

#include "scenes/built_in/built_in.h"
#include "scenes/built_in/outdoors.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {

Mesh make_tree(const Look& bark, const Look& leaves, std::uint32_t seed) {
  Random random(seed);
  Mesh mesh;
  add_part(mesh,
           tube({{0.0, -0.3, 0.0}, {0.02, 0.8, 0.0}, {0.1, 2.0, 0.05}, {0.05, 3.6, 0.1}},
                {0.30, 0.19, 0.16, 0.08}, 10),
           bark, glm::dmat4(1.0), 60.0);
  for (int i = 0; i < 9; ++i) {
    const glm::dvec2 c = circle(40.0 * i * 3.0 + random.range(-20.0, 20.0));
    const double height = 2.7 + 0.34 * i,
                 reach = 1.15 * (1.0 - 0.085 * i) * (i % 3 == 0 ? 0.4 : 1.0);
    const double size = random.range(0.85, 1.2) * (1.0 - 0.03 * i);
    add_part(mesh, boulder(seed * 17 + static_cast<std::uint32_t>(i), 0.9, 14, 9), leaves,
             move({reach * c.x, height, reach * c.y}) * turn_y(random.range(0.0, 360.0)) *
                 stretch({size, 0.82 * size, size}),
             50.0);
  }
  return mesh;
}

namespace {

/// Places in an area of which no two are nearer than `apart`, metres; seeded.
std::vector<glm::dvec2> scattered(Random& random, const glm::dvec2& low, const glm::dvec2& high,
                                  std::size_t count, double apart) {
  std::vector<glm::dvec2> places;
  while (places.size() < count) {
    const double x = random.range(low.x, high.x), z = random.range(low.y, high.y);
    bool free = true;
    for (const glm::dvec2& other : places)
      free = free && glm::length(other - glm::dvec2(x, z)) >= apart;
    if (free) places.emplace_back(x, z);
  }
  return places;
}

}  // namespace

/// Copies of one tree on a meadow, from near the camera to far away: casters with boxes of their
/// own, small beside the scene (Alecu 2014, 4).
Scene make_trees() {
  SceneBuilder b("trees", "Trees on a meadow");
  const Look meadow = b.look("meadow", {0.95f, 0.97f, 0.90f}, b.texture("grass", 101), 7.0);
  const Look bark = b.look("bark", {0.9f, 0.88f, 0.85f}, b.texture("bark", 102), 1.0);
  const Look leaves = b.look("leaves", {0.90f, 0.97f, 0.78f}, b.texture("leaf", 103), 1.6);
  const Look stone = b.look("stone", {0.95f, 0.93f, 0.90f}, b.texture("rock", 104), 1.6);
  const Look wood = b.look("fence", {0.86f, 0.80f, 0.72f}, b.texture("wood", 105), 1.2);
  b.ground({-60.0, -120.0}, {60.0, 24.0}, meadow, "meadow", 0.5);
  const std::uint32_t tree = b.add_mesh("tree", make_tree(bark, leaves, 7));
  Random random(2014);
  const std::vector<glm::dvec2> places = scattered(random, {-34.0, -92.0}, {34.0, 2.0}, 60, 6.5);
  for (const glm::dvec2& at : places) {
    const double size = random.range(0.8, 1.35);
    b.place(tree, move({at.x, 0.0, at.y}) * turn_y(random.range(0.0, 360.0)) *
                      stretch({size, size * random.range(0.9, 1.15), size}));
  }
  Mesh rock;
  add_part(rock, boulder(106, 0.75, 16, 10), stone, glm::dmat4(1.0), 40.0);
  const std::uint32_t rocks = b.add_mesh("rock", std::move(rock));
  for (const glm::dvec2& at : scattered(random, {-24.0, -40.0}, {24.0, 8.0}, 14, 4.0)) {
    const double size = random.range(0.25, 0.7);
    b.place(rocks, move({at.x, 0.25 * size, at.y}) * turn_y(random.range(0.0, 360.0)) *
                       stretch({1.3 * size, 0.8 * size, size}));
  }
  Mesh fence;
  add_fence(fence, {-26.0, 0.0, 4.5}, {-2.0, 0.0, 6.5}, wood);
  add_fence(fence, {2.2, 0.0, 6.6}, {26.0, 0.0, 4.0}, wood);
  b.place(b.add_mesh("fence", std::move(fence)), glm::dmat4(1.0));
  b.sun({-0.62, -0.66, 0.42}, {1.0f, 0.94f, 0.82f}, 1.2f);
  b.camera("main", {3.5, 5.2, 17.5}, {-1.0, 1.2, -10.0}, 46.0);
  b.camera("above", {0.0, 48.0, 34.0}, {0.0, 0.0, -34.0}, 50.0);
  add_sky(b.scene);
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
