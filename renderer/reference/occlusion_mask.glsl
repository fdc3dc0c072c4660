// Reads what occlusion_mask.comp wrote.
#include "renderer/shaders/texel.glsl"

uniform usampler2D occlusion_mask;

float calculate_shadow(ShadowQuery query) {
  uint mask = texel_of(occlusion_mask, ivec2(query.pixel)).r;
  return (mask >> query.point & 1u) == 0u ? 1.0 : 0.0;
}
