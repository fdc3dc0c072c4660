// Moments of depth warped by exponentials, filtered along rows. Depth 1 is the cleared map's.
#define ENCODE
#include "renderer/shadow_maps/half_range.glsl"
vec4 encode_depth(float depth) {
  float positive = exp(parameter_c_positive * depth);
  float negative = -exp(-parameter_c_negative * depth);
  return vec4(in_format(positive), in_format(positive * positive), negative, negative * negative);
}
#include "renderer/shadow_maps/blurred_map.frag"
