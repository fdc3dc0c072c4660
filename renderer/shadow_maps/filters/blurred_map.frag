// One direction of a separable filter over a map: columns of what was filtered along rows. With ENCODE,
// and a technique's vec4 encode_depth(float) before it, it reads and encodes rows of the depth map.
//
// Without a further definition the filter takes means. FILTER_LOGARITHMS: the first component holds
// logarithms, and the result is the logarithm of the mean of what they encode. FILTER_MAXIMUM: the
// result is the greatest value.
#include "renderer/shadow_maps/filters/blur_weights.glsl"

layout(location = 0) out vec4 out_value;

// Of one view. Texels beyond the border repeat it.
#ifdef ENCODE
uniform sampler2D depths;

vec4 value_at(int offset) {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  texel.x = clamp(texel.x + offset, 0, textureSize(depths, 0).x - 1);
  return encode_depth(texelFetch(depths, texel, 0).r);
}
#else
uniform sampler2D blurred_rows;

vec4 value_at(int offset) {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  texel.y = clamp(texel.y + offset, 0, textureSize(blurred_rows, 0).y - 1);
  return texelFetch(blurred_rows, texel, 0);
}
#endif

#if defined(FILTER_LOGARITHMS)
// The greatest term is kept apart: exponentials of the others then lie between 0 and 1.
vec4 filtered() {
  float greatest = value_at(0).r;
  float sum = 0.0;
  float total = 0.0;
  for (int i = -parameter_blur; i <= parameter_blur; ++i) {
    float value = value_at(i).r;
    float top = max(greatest, value);
    sum = sum * exp(greatest - top) + blur_weight(i) * exp(value - top);
    greatest = top;
    total += blur_weight(i);
  }
  return vec4(greatest + log(sum / total), 0.0, 0.0, 0.0);
}
#elif defined(FILTER_MAXIMUM)
vec4 filtered() {
  vec4 greatest = value_at(0);
  for (int i = -parameter_blur; i <= parameter_blur; ++i) greatest = max(greatest, value_at(i));
  return greatest;
}
#else
// Weights are made small before they are added up, and not moved behind the sum by a compiler (precise):
// a sum of values near the format's end would leave it where their mean does not.
vec4 filtered() {
  const float share = 1.0 / float(2 * parameter_blur + 1);
  precise vec4 sum = vec4(0.0);
  float total = 0.0;
  for (int i = -parameter_blur; i <= parameter_blur; ++i) {
    sum += (share * blur_weight(i)) * value_at(i);
    total += share * blur_weight(i);
  }
  return sum / total;
}
#endif

void main() { out_value = filtered(); }
