// Exponentials of depth, or their logarithms. Depth 1 is the cleared map's.
#include "renderer/shadow_maps/filters/half_range.glsl"
vec4 encode_depth(float depth) {
  float logarithm = parameter_c * depth;
  bool kept = parameter_filtering == filtering_logarithmic;
  return vec4(kept ? logarithm : in_format(exp(logarithm)), 0.0, 0.0, 0.0);
}
