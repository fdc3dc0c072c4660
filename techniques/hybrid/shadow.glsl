#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_volumes/read_stencil.glsl"
#include "techniques/hybrid/mask.glsl"

uniform sampler2D hybrid_mask;

float calculate_shadow(ShadowQuery query) {
  float mask = texel_of(hybrid_mask, ivec2(query.pixel)).r;
  if (is_silhouette_mask(mask)) return count_masked_volumes(query.pixel) == 0u ? 1.0 : 0.0;
  return mask > 0.5 ? 1.0 : 0.0;
}

// The map's results in grey, samples that volumes decide in red (dark) and yellow (lit).
vec4 draw_diagnostic_mask(ShadowQuery query, vec2 picture) {
  float mask = texel_of(hybrid_mask, ivec2(query.pixel)).r;
  if (query.point < 0) return vec4(0.1, 0.1, 0.2, 1.0);
  if (!is_silhouette_mask(mask)) return vec4(vec3(mix(0.3, 0.85, mask)), 1.0);
  return count_masked_volumes(query.pixel) == 0u ? vec4(1.0, 0.85, 0.1, 1.0) : vec4(0.9, 0.1, 0.1, 1.0);
}
