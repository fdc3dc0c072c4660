#include <string>

#include "scenes/built_in/outdoors.h"
#include "scenes/built_in/warehouse_parts.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {

void add_crane(SceneBuilder& b) {
  const Look yellow = b.look("crane yellow", {0.86f, 0.62f, 0.08f}, b.texture("painted_metal", 54),
                             1.5, 0.1f, 40.0f);
  const Look chain = b.look("chain", {0.25f, 0.25f, 0.26f}, -1, 1.0, 0.2f, 60.0f);
  const Look wood = b.look("load", {1.0f, 0.94f, 0.84f}, b.texture("wood", 55), 1.1);
  Mesh mesh;
  for (const double x : {-0.55, 0.15})
    add_part(mesh, box({x - 0.09, 4.62, -8.45}, {x + 0.09, 4.98, 8.45}), yellow);
  for (const double z : {-8.3, -4.0, 4.0, 8.3})
    add_part(mesh, box({-0.47, 4.70, z - 0.06}, {0.07, 4.90, z + 0.06}), yellow);
  add_part(mesh, rounded_box({-0.75, 4.985, 0.35}, {0.35, 5.25, 1.15}, 0.04, 1), yellow);
  for (const double z : {0.68, 0.82})
    add_part(mesh, cylinder(0.018, 0.018, 1.95, 8), chain, move({-0.2, 3.05, z}), 60.0);
  add_part(mesh, rounded_box({-0.29, 2.82, 0.62}, {-0.11, 3.10, 0.88}, 0.03, 1), yellow);
  b.place(b.add_mesh("crane", std::move(mesh)), glm::dmat4(1.0));
  // Four slings from the hook to the load.
  Mesh load = make_slatted_crate(wood, 1.1);
  for (const double x : {-0.5, 0.5})
    for (const double z : {-0.5, 0.5})
      add_part(load,
               tube({{0.0, 1.72, 0.0}, {0.5 * x, 1.41, 0.5 * z}, {x, 1.08, z}},
                    {0.015, 0.015, 0.015}, 6),
               chain, glm::dmat4(1.0), 60.0);
  b.place(b.add_mesh("load", std::move(load)), move({-0.2, 1.15, 0.75}) * turn_y(24.0));
}

void add_yard(SceneBuilder& b) {
  const Look paint = b.look("road paint", {0.80f, 0.80f, 0.76f}, b.texture("plaster", 67), 2.0);
  const Look kerb = b.look("kerb", {0.85f, 0.84f, 0.82f}, b.texture("concrete", 68), 3.0);
  const Look bark = b.look("tree bark", {0.9f, 0.88f, 0.85f}, b.texture("bark", 69), 1.0);
  const Look leaves = b.look("leaves", {0.90f, 0.95f, 0.80f}, b.texture("grass", 70), 2.5);
  Mesh lines;
  for (int i = 0; i < 9; ++i)
    add_part(lines, box({-26.0 + 3.2 * i, -0.01, 22.0}, {-25.85 + 3.2 * i, 0.012, 27.5}), paint);
  for (int i = 0; i < 7; ++i)
    add_part(lines, box({-24.0 + 8.0 * i, -0.01, 31.0}, {-20.5 + 8.0 * i, 0.012, 31.2}), paint);
  for (const double x : {-2.3, 2.15})
    add_part(lines, box({x, -0.01, 9.6}, {x + 0.15, 0.012, 14.5}), paint);
  b.place(b.add_mesh("markings", std::move(lines)), glm::dmat4(1.0));
  Mesh rim;
  add_part(rim, box({-32.2, -0.3, -19.2}, {-32.0, 0.14, 36.2}), kerb);
  add_part(rim, box({34.0, -0.3, -19.2}, {34.2, 0.14, 36.2}), kerb);
  add_part(rim, box({-31.99, -0.3, -19.2}, {33.99, 0.141, -19.0}), kerb);
  add_part(rim, box({-31.99, -0.3, 36.0}, {33.99, 0.141, 36.2}), kerb);
  b.place(b.add_mesh("kerb", std::move(rim)), glm::dmat4(1.0));
  const std::uint32_t trees[2] = {b.add_mesh("tree 1", make_tree(bark, leaves, 3)),
                                  b.add_mesh("tree 2", make_tree(bark, leaves, 4))};
  const double at[13][3] = {{-22.0, -22.5, 1.1}, {-14.0, -23.5, 1.0}, {-5.5, -22.8, 1.2},
                            {3.0, -24.0, 0.95},  {11.0, -22.6, 1.1},  {19.5, -23.6, 1.15},
                            {-35.5, -8.0, 1.1},  {-36.4, 2.0, 1.0},   {-35.2, 12.5, 1.2},
                            {-37.0, 22.5, 1.05}, {27.0, -22.9, 1.0},  {-29.0, -24.6, 1.0},
                            {-36.0, 32.0, 1.0}};
  for (int i = 0; i < 13; ++i)
    b.place(trees[i % 2],
            move({at[i][0], -0.06, at[i][1]}) * turn_y(77.0 * i) * stretch(glm::dvec3(at[i][2])));
}

}  // namespace penumbra::scenes
