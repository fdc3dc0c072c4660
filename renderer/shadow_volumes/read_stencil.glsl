// Reading the count of volumes that a sample of the frame lies in.
#ifndef PENUMBRA_READ_STENCIL_GLSL
#define PENUMBRA_READ_STENCIL_GLSL
#include "renderer/shaders/texel.glsl"

uniform usampler2D volume_count;

// 0 .. 255; what is more reads 255 (deep_counts.h).
uint count_volumes(vec2 pixel) { return texel_of(volume_count, ivec2(pixel)).r; }

// 0 .. 127, what is more 127, where the highest bit marks samples in which volumes were counted.
uint count_masked_volumes(vec2 pixel) { return count_volumes(pixel) & 0x7fu; }

// Zero is grey; one and more run from yellow over red; what wrapped below zero is blue.
vec4 picture_of_count(uint count) {
  if (count == 0u) return vec4(0.35, 0.35, 0.35, 1.0);
  if (count >= 128u) return vec4(0.2, 0.3, 0.5 + float(count - 128u) / 256.0, 1.0);
  float share = clamp(log2(float(count)) / 5.0, 0.0, 1.0);
  return vec4(mix(vec3(1.0, 0.9, 0.2), vec3(0.6, 0.0, 0.1), share), 1.0);
}
#endif
