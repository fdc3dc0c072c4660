#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_volumes/overlap_counts.glsl"
#include "renderer/shadow_volumes/read_stencil.glsl"

uniform sampler2D wedge_coverage;
uniform sampler2D first_counts;
uniform sampler2D second_counts;

// What the wedges add to the part of the light that is hidden, or take away; 0 for lights that have no
// extent and so no wedges.
float wedge_correction(vec2 pixel) {
  return light_half_size().x > 0.0 ? texel_of(wedge_coverage, ivec2(pixel)).r : 0.0;
}

// Mean over points of the light of how often each is counted more than once, given the count of its
// centre; negative counts mean the opposite.
float counted_too_often(float center, vec4 packed) {
  float excess = 0.0;
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < counts_per_float; ++k) {
      float count = center + next_count(packed[i]);
      excess += count - clamp(count, 0.0, 1.0);
    }
  return excess / float(coverage_point_count);
}

float calculate_shadow(ShadowQuery query) {
  float center = float(count_volumes(query.pixel));
  float hidden = center + wedge_correction(query.pixel);
  if (parameter_overlap == overlap_count && light_half_size().x > 0.0) {
    ivec2 texel = ivec2(query.pixel);
    hidden -= counted_too_often(center, texel_of(first_counts, texel)) +
              counted_too_often(center, texel_of(second_counts, texel));
  }
  return clamp(1.0 - hidden, 0.0, 1.0);
}

vec4 draw_diagnostic_count(ShadowQuery query, vec2 picture) {
  return picture_of_count(count_volumes(query.pixel));
}

vec4 draw_diagnostic_wedges(ShadowQuery query, vec2 picture) {
  float correction = query.point < 0 ? 0.0 : wedge_correction(query.pixel);
  vec3 color = correction < 0.0 ? vec3(0.1, 0.3, 1.0) : vec3(1.0, 0.25, 0.1);
  float center = query.point < 0 || count_volumes(query.pixel) == 0u ? 0.9 : 0.5;
  return vec4(mix(vec3(center), color, min(abs(correction) * 2.0, 1.0)), 1.0);
}
