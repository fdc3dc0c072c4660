uniform sampler2D covered;

float calculate_shadow(ShadowQuery query) {
  return texelFetch(covered, ivec2(query.pixel), 0).r > 0.5 ? 0.0 : 1.0;
}
