#pragma once

#include "scenes/generators/scene_builder.h"

namespace penumbra::scenes {

struct CarLooks {
  Look paint, glass, chrome, rubber, lamp, tail_lamp;
};

/// Small saloon, 3.9 m long, its nose towards +x, its wheels on y = 0.
Mesh make_car_mesh(const CarLooks& looks);

}  // namespace penumbra::scenes
