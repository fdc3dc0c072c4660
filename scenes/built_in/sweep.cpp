#include <algorithm>
#include <cmath>

#include "scenes/built_in/built_in.h"
#include "scenes/generators/random.h"
#include "scenes/generators/scene_builder.h"

namespace penumbra::scenes {
namespace {

struct SweepSize {
  int objects = 0;
  int triangles = 0;
  int lights = 0;
};

SweepSize parse(const std::string& name) {
  const Error error =
      bad_value("scene", "'" + name + "' is no sweep scene: sweep:<objects 1..1000>x<triangles " +
                             "50..100000>x<lights 1..8>, such as sweep:25x1600x2");
  const std::vector<int> values = numbers_of(name, "sweep:", 3, error);
  const SweepSize size{values[0], values[1], values[2]};
  if (size.objects < 1 || size.objects > 1000 || size.triangles < 50 || size.triangles > 100000 ||
      size.lights < 1 || size.lights > 8)
    throw error;
  return size;
}

/// The same knot at every triangle count, so that only the count changes: about three times as many
/// steps along as sides around.
Solid knot(int triangles) {
  const int sides =
      triangles < 200 ? 3 : std::max(4, static_cast<int>(std::sqrt(triangles / 6.25)));
  return trefoil(0.13, (triangles + sides) / (2 * sides), sides);
}

}  // namespace

Scene make_sweep(const std::string& name) {
  const SweepSize size = parse(name);
  SceneBuilder b(name, std::to_string(size.objects) + " knots of " +
                           std::to_string(size.triangles) + " triangles, " +
                           std::to_string(size.lights) + " lights");
  // Objects stand on a square grid at one density, so that they shadow each other at every count.
  const int columns = static_cast<int>(std::ceil(std::sqrt(size.objects)));
  const double spacing = 1.25;
  const double half = 0.5 * spacing * columns;
  const int plaster = b.texture("plaster");
  const Look floor = b.look("floor", {0.62f, 0.62f, 0.62f}, b.texture("concrete"), 3.0);
  const Look colors[4] = {b.look("red", {0.72f, 0.28f, 0.20f}, plaster, 1.0, 0.08f, 48.0f),
                          b.look("ochre", {0.78f, 0.58f, 0.26f}, plaster, 1.0, 0.08f, 48.0f),
                          b.look("teal", {0.24f, 0.52f, 0.50f}, plaster, 1.0, 0.08f, 48.0f),
                          b.look("cream", {0.82f, 0.78f, 0.68f}, plaster, 1.0, 0.08f, 48.0f)};
  const double margin = half + 1.5;
  b.ground({-margin, -margin}, {margin, margin}, floor);

  std::uint32_t meshes[4];
  for (int i = 0; i < 4; ++i) {
    Mesh mesh;
    add_part(mesh, knot(size.triangles), colors[i], glm::dmat4(1.0), 60.0);
    meshes[i] = b.add_mesh("knot " + std::to_string(i), std::move(mesh));
  }
  Random random(2007);
  for (int i = 0; i < size.objects; ++i) {
    const double x = (i % columns + 0.5) * spacing - half + random.range(-0.12, 0.12);
    const double z = (i / columns + 0.5) * spacing - half + random.range(-0.12, 0.12);
    const double scale = random.range(0.85, 1.1);
    const glm::dmat4 turned = turn_y(random.range(0.0, 360.0)) * turn_x(random.range(-35.0, 35.0));
    const std::uint32_t mesh = meshes[random.below(4)];
    // Any turn of the knot fits a sphere of 0.6 m.
    b.place(mesh, move({x, 0.62 * scale, z}) * turned * stretch(glm::dvec3(scale)),
            "knot " + std::to_string(i));
  }

  const double reach = half + 0.8;
  for (int i = 0; i < size.lights; ++i) {
    const glm::dvec2 c = circle(-130.0 + 360.0 * i / size.lights);
    const glm::dvec3 position(1.5 * reach * c.x, 1.9 * reach + 1.0, 1.5 * reach * c.y);
    const glm::vec3 tints[3] = {{1.0f, 0.96f, 0.88f}, {0.86f, 0.93f, 1.0f}, {1.0f, 0.90f, 0.84f}};
    b.spot("light " + std::to_string(i + 1), position, {0, 0.3, 0}, tints[i % 3],
           1.25f / static_cast<float>(size.lights), 32.0, disc(0.12 * reach));
  }
  b.camera("main", glm::dvec3(0.9, 1.75, 2.25) * (half + 0.55), {0.0, 0.15, 0.05 * half}, 38.0);
  b.scene.ambient = glm::vec3(0.10f);
  return std::move(b.scene);
}

}  // namespace penumbra::scenes
