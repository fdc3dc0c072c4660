#include "scenes/built_in/warehouse_parts.h"

#include "scenes/generators/random.h"

namespace penumbra::scenes {

/// Pallet rack, 5.6 m long, 1.1 m deep, with three levels at 0.15, 1.75 and 3.35 m.
Mesh make_rack(const Look& posts, const Look& boards) {
  Mesh mesh;
  for (const double x : {-2.75, 0.0, 2.75}) {
    for (const double z : {-0.5, 0.5})
      add_part(mesh, box({x - 0.05, 0.0, z - 0.05}, {x + 0.05, 4.3, z + 0.05}), posts);
    for (int i = 0; i < 5; ++i) {
      const double low = 0.3 + 0.78 * i;
      add_part(
          mesh,
          bar({x, low, i % 2 ? -0.47 : 0.47}, {x, low + 0.7, i % 2 ? 0.47 : -0.47}, 0.03, 0.04),
          posts);
    }
  }
  for (const double y : {0.15, 1.75, 3.35}) {
    for (const double z : {-0.45, 0.45})
      add_part(mesh, box({-2.84, y - 0.13, z - 0.025}, {2.84, y - 0.005, z + 0.025}), posts);
    for (int i = 0; i < 2; ++i)
      add_part(mesh, box({-2.68 + 2.75 * i, y, -0.58}, {-0.07 + 2.75 * i, y + 0.03, 0.58}), boards);
  }
  return mesh;
}

/// Cube of boards with gaps between them, so that light falls through.
Mesh make_slatted_crate(const Look& wood, double size) {
  Mesh mesh;
  const double half = 0.5 * size, board = size / 5.0, thick = 0.03 * size;
  for (const double x : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0}) {
      const glm::dvec3 corner(x * (half - 1.6 * thick), 0.0, z * (half - 1.6 * thick));
      add_part(mesh,
               box(corner - glm::dvec3(0.6 * thick, -0.002, 0.6 * thick),
                   corner + glm::dvec3(0.6 * thick, size - 0.004, 0.6 * thick)),
               wood);
    }
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < 5; ++i)
      add_part(
          mesh,
          box({-half + thick * (side % 2 ? 1.002 : 0.0), board * i + 0.08 * board, half - thick},
              {half - thick * (side % 2 ? 1.002 : 0.0), board * (i + 1) - 0.08 * board, half}),
          wood, turn_y(90.0 * side));
  for (int i = 0; i < 5; ++i) {
    const double x = -half + board * i;
    add_part(mesh,
             box({x + 0.06 * board, size - 0.07 * board, -half - 0.004},
                 {x + 0.94 * board, size, half + 0.004}),
             wood);
  }
  add_part(mesh,
           box({-half + thick, 0.004, -half + thick}, {half - thick, 0.004 + thick, half - thick}),
           wood);
  return mesh;
}

Mesh make_pallet(const Look& wood) {
  Mesh mesh;
  for (int i = 0; i < 7; ++i) {
    const double x = -0.6 + 0.175 * i;
    add_part(mesh, box({x, 0.122, -0.4}, {x + 0.13, 0.144, 0.4}), wood);
  }
  for (int j = 0; j < 3; ++j) {
    const double z = -0.35 + 0.35 * j;
    for (int i = 0; i < 3; ++i) {
      const double x = -0.53 + 0.53 * i;
      add_part(mesh, box({x - 0.06, 0.022, z - 0.045}, {x + 0.06, 0.1, z + 0.045}), wood);
    }
    add_part(mesh, box({-0.59, 0.1, z - 0.047}, {0.57, 0.122, z + 0.047}), wood);
    add_part(mesh, box({-0.59, 0.0, z - 0.046}, {0.57, 0.022, z + 0.046}), wood);
  }
  return mesh;
}

Mesh make_barrel(const Look& paint) {
  Mesh mesh;
  std::vector<glm::dvec2> profile = {{0.0, 0.0}, {0.28, 0.0}, {0.29, 0.015}};
  for (const double y : {0.28, 0.57}) {
    profile.emplace_back(0.285, y - 0.02);
    profile.emplace_back(0.302, y);
    profile.emplace_back(0.285, y + 0.02);
  }
  profile.insert(profile.end(),
                 {{0.29, 0.87}, {0.28, 0.885}, {0.268, 0.885}, {0.266, 0.865}, {0.0, 0.865}});
  add_part(mesh, lathe(profile, 28), paint, glm::dmat4(1.0), 40.0);
  return mesh;
}

Mesh make_hand_truck(const Look& metal, const Look& rubber) {
  Mesh mesh;
  const glm::dmat4 lean = move({0.0, 0.13, 0.0}) * turn_x(-14.0);
  for (const double x : {-0.2, 0.2})
    add_part(mesh,
             tube({{x, -0.1, 0.0}, {x, 1.1, 0.0}, {0.8 * x, 1.2, -0.08}}, {0.018, 0.018, 0.018}, 8),
             metal, lean, 60.0);
  for (const double y : {0.15, 0.45, 0.75, 1.0})
    add_part(mesh, bar({-0.2, y, 0.0}, {0.2, y, 0.0}, 0.02, 0.03), metal, lean);
  add_part(mesh, box({-0.24, -0.1, 0.02}, {0.24, -0.085, 0.3}), metal, lean);
  for (const double x : {-0.3, 0.26})
    add_part(mesh, cylinder(0.13, 0.13, 0.05, 20), rubber, move({x, 0.13, -0.05}) * turn_z(-90.0),
             40.0);
  return mesh;
}

/// Lorry that looks along +z, 7.4 m long.
Mesh make_lorry(const Look& cab, const Look& cargo, const Look& dark, const Look& rubber) {
  Mesh mesh;
  add_part(mesh, rounded_box({-1.2, 1.0, -3.9}, {1.2, 3.5, 1.55}, 0.04, 2), cargo);
  for (int i = 0; i < 6; ++i)
    for (const double x : {-1.215, 1.215})
      add_part(mesh, box({x - 0.02, 1.08, -3.5 + 0.95 * i}, {x + 0.02, 3.42, -3.44 + 0.95 * i}),
               cargo);
  add_part(mesh, box({-0.55, 0.62, -3.8}, {0.55, 0.96, 3.2}), dark);
  // Cab: side view in (z, y), swept across.
  const std::vector<glm::dvec2> side = {{1.75, 0.62}, {3.35, 0.62}, {3.42, 0.8},  {3.40, 1.62},
                                        {3.05, 2.55}, {2.85, 2.68}, {1.85, 2.68}, {1.75, 2.58}};
  const glm::dmat4 sideways = turn_y(-90.0);
  add_part(mesh, extrude(side, 2.2), cab, sideways, 25.0);
  add_part(
      mesh,
      loft({{{-0.98, 1.66, 3.395}, {0.98, 1.66, 3.395}, {0.92, 2.42, 3.11}, {-0.92, 2.42, 3.11}},
            {{-0.98, 1.67, 3.42}, {0.98, 1.67, 3.42}, {0.92, 2.43, 3.135}, {-0.92, 2.43, 3.135}}}),
      dark);
  for (const double x : {-1.105, 1.105})
    add_part(mesh, box({x - 0.012, 1.66, 2.1}, {x + 0.012, 2.42, 3.02}), dark);
  add_part(mesh, rounded_box({-1.12, 0.42, 3.2}, {1.12, 0.78, 3.55}, 0.05, 2), dark);
  for (const double z : {-2.9, -1.85, 2.5})
    for (const double x : {-1.12, 0.82})
      add_part(mesh,
               lathe({{0.0, 0.0},
                      {0.28, 0.0},
                      {0.42, 0.0},
                      {0.48, 0.06},
                      {0.48, 0.24},
                      {0.42, 0.3},
                      {0.28, 0.3},
                      {0.0, 0.3}},
                     24),
               rubber, move({x + 0.3, 0.48, z}) * turn_z(90.0), 40.0);
  return mesh;
}

}  // namespace penumbra::scenes
