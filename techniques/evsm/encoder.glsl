// Moments of depth warped by exponentials. Depth 1 is the cleared map's.
#include "renderer/shadow_maps/filters/half_range.glsl"
vec4 encode_depth(float depth) {
  float positive = exp(parameter_c_positive * depth);
  // Centred, so that neither end underflows before the other overflows.
  float negative = exp(parameter_c_negative * (0.5 - depth));
  return vec4(in_format(positive), in_format(positive * positive), -in_format(negative),
              in_format(negative * negative));
}
