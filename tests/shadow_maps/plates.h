#pragma once

#include "scenes.h"

namespace penumbra::tests {

/// Ground of 4 m x 4 m and a plate of 2 m x 2 m `height` over it, under a sun overhead. Depth runs
/// from the plate, 0, to the ground, 1 / 1.0001: the map's range is a ten-thousandth wider.
inline Scene plate_over_ground(double height = 1.0) {
  Scene scene = empty_scene(0.9 * height, 1.0);
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  add_plate(scene, {-1, -1}, {1, 1}, height);
  scene.lights.push_back(sun());
  return scene;
}

}  // namespace penumbra::tests
