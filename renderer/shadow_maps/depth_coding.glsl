// What a map keeps of a depth that runs evenly from 0 at near to 1 at far. Parameters `depth` and
// `depth_bits` choose; techniques without them keep it as it is, in 32 bits.
#ifndef PENUMBRA_DEPTH_CODING_GLSL
#define PENUMBRA_DEPTH_CODING_GLSL
#include "renderer/shaders/shader_types.h"

layout(std140) uniform MapBlock { MapData map; };

#ifdef variant_depth_hyperbolic
// As a projection leaves it after the division by w: even in 1/z. Parallel rays have no such division.
bool is_divided() { return map.faces[0].origin.w > 0.5; }

float coded_depth(float depth) {
  if (!is_divided()) return depth;
  depth = clamp(depth, 0.0, 1.0);
  return depth * map.range.y / (map.range.x + depth / map.range.z);
}

float even_depth(float coded) {
  if (!is_divided()) return coded;
  return coded * map.range.x / (map.range.y - coded / map.range.z);
}

/// Change of distance for a change of what is kept, m, at this distance along the axis.
float coding_slope(float distance) {
  if (!is_divided()) return 1.0 / map.range.z;
  return distance * distance / (map.range.x * map.range.y * map.range.z);
}
#else
float coded_depth(float depth) { return depth; }
float even_depth(float coded) { return coded; }
float coding_slope(float distance) { return 1.0 / map.range.z; }
#endif

/// How far a kept depth may lie from the one that was meant, m: half a step of 16 bits, two units in
/// the last place of a float below 1. Even depth in 32 bits loses less than positions do, which are
/// floats too.
float coding_error(float distance) {
#if defined(variant_depth_bits_16)
  return 0.5 / 65535.0 * coding_slope(distance);
#elif defined(variant_depth_hyperbolic)
  return exp2(-23.0) * coding_slope(distance);
#else
  return 0.0;
#endif
}
#endif
