#pragma once

#include "experiments/claims/laboratory.h"

/// What claims on layouts are judged by: hard shadows, whose truth is one ray a pixel.
namespace penumbra::experiments::claims {

using SharedScene = std::shared_ptr<const Scene>;

/// Lights without extents, so that one ray a pixel is the truth.
SharedScene with_hard_lights(Scene scene);

inline constexpr const char* one_ray = "ray-traced:rays=1";

/// What a technique of one light leaves to the truth; over rows from `first` to before `end`, as
/// shares of the picture's height.
double error_in_rows(const RenderResult& drawn, const RenderResult& truth, double first,
                     double end);
double error_to(const RenderResult& drawn, const RenderResult& truth);

/// The two axes that span the plane across a light's direction, and do not turn with the camera.
struct FixedAxes {
  glm::dvec3 right, up, forward;
};

FixedAxes axes_of(const Light& light);

/// Mean share of points of the village whose visibility changes between neighbouring frames of a
/// camera above it that moves by five pixels each, or of a light that turns by half a degree.
double flicker(Laboratory& lab, const std::string& technique, bool light_moves);

}  // namespace penumbra::experiments::claims
