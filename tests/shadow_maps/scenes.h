#pragma once

#include "renderer/scene/scene.h"

/// Small scenes whose maps can be drawn by hand.
namespace penumbra::tests {

/// A scene with one white material and a camera that looks at the origin from straight above.
Scene empty_scene(double camera_height, double width);

/// Two triangles in the plane y, facing up, double-sided by material 0.
void add_plate(Scene& scene, const glm::dvec2& low, const glm::dvec2& high, double y,
               bool casts_shadow = true);

/// Closed box, counter-clockwise from outside.
void add_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high);

/// Light from straight above.
Light sun();

/// Spot light at a place, turned straight down, with a hard edge at `half_angle` degrees.
Light lamp(const glm::dvec3& position, double half_angle);

}  // namespace penumbra::tests
