// The points of a batch, and how to do a thing for each of them.
#ifndef PENUMBRA_LIGHT_POINTS_GLSL
#define PENUMBRA_LIGHT_POINTS_GLSL
#include "renderer/shaders/shader_types.h"

// Positions, or unit directions to a directional light; only the first light.cone.z are points of the
// batch. Samples at different places in their pixels have different points.
layout(std140) uniform LightPointBlock { vec4 light_points[points_per_batch]; };

// f(0) f(1) ... f(31). Drivers share what unrolled code has in common: hence no loop.
#define FOUR_POINTS(f, i) f(i) f(i + 1) f(i + 2) f(i + 3)
#define ALL_POINTS(f)                                                                       \
  FOUR_POINTS(f, 0) FOUR_POINTS(f, 4) FOUR_POINTS(f, 8) FOUR_POINTS(f, 12) FOUR_POINTS(f, 16) \
  FOUR_POINTS(f, 20) FOUR_POINTS(f, 24) FOUR_POINTS(f, 28)
#endif
