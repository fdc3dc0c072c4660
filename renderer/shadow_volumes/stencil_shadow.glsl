// The shader of techniques that return the count in the stencil.
#include "renderer/shadow_volumes/read_stencil.glsl"

float calculate_shadow(ShadowQuery query) { return count_volumes(query.pixel) == 0u ? 1.0 : 0.0; }

vec4 draw_diagnostic_count(ShadowQuery query, vec2 picture) {
  return picture_of_count(count_volumes(query.pixel));
}
