// The points of a batch, and how to do a thing for each of them.
#ifndef PENUMBRA_LIGHT_POINTS_GLSL
#define PENUMBRA_LIGHT_POINTS_GLSL
#include "renderer/shaders/shader_types.h"
#include "renderer/shaders/unroll.glsl"

// Positions, or unit directions to a directional light; only the first light.cone.z are points of the
// batch. Samples at different places in their pixels have different points.
layout(std140) uniform LightPointBlock { vec4 light_points[points_per_batch]; };

#define ALL_POINTS(f) UNROLL_32(f)
#endif
