// Reads what occlusion_mask.comp wrote.
uniform usampler2D occlusion_mask;

float calculate_shadow(ShadowQuery query) {
  uint mask = texelFetch(occlusion_mask, ivec2(query.pixel), 0).r;
  return (mask >> query.point & 1u) == 0u ? 1.0 : 0.0;
}
