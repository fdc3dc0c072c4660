// Reads what the passes of renderer/reference/ wrote.
#include "renderer/reference/mask_place.glsl"

uniform usamplerBuffer occlusion_masks;  // of all samples of the frame, row by row

float calculate_shadow(ShadowQuery query) {
  uint mask = texelFetch(occlusion_masks, int(mask_place(ivec2(query.pixel)))).r;
  return (mask >> query.point & 1u) == 0u ? 1.0 : 0.0;
}
