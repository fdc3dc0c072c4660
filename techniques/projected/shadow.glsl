#include "renderer/shaders/texel.glsl"

uniform sampler2D covered;

float calculate_shadow(ShadowQuery query) {
  return texel_of(covered, ivec2(query.pixel)).r > 0.5 ? 0.0 : 1.0;
}
