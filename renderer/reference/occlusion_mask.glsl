// Reads what the passes of renderer/reference/ wrote.
#include "renderer/shaders/frame.glsl"

uniform usamplerBuffer occlusion_masks;  // of all samples of the frame, row by row

float calculate_shadow(ShadowQuery query) {
  ivec2 texel = ivec2(query.pixel);
  uint mask = texelFetch(occlusion_masks, texel.y * int(frame.size.x) + texel.x).r;
  return (mask >> query.point & 1u) == 0u ? 1.0 : 0.0;
}
