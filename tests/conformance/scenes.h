#pragma once

#include <memory>

#include "renderer/render.h"

/// Small scenes whose answer is known without rendering.
namespace penumbra::test {

/// One for all cases, under the validation layer: any message fails the render that it belongs to.
Renderer& renderer();

/// Closed box, counter-clockwise from outside, as an instance of its own mesh.
void add_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high);

/// A ground slab of 4 x 4 m with its top at y = 0, declared as planar receiver, seen from straight
/// above by an orthographic camera 2 m high, lit by a spot light from 4 m above. Nothing stands on
/// it.
Scene open_ground();

/// The same with a slab at y = 1 that hides the light from all of the ground; the camera looks
/// under it from the side, standing in the light.
Scene covered_ground();

/// The same with a box of half a metre and the light a little to the side.
Scene box_on_ground();

}  // namespace penumbra::test
