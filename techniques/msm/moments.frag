// The first four moments of depth from -1 to 1, filtered along rows.
#define ENCODE
#include "techniques/msm/quantization.glsl"
vec4 encode_depth(float depth) {
  float z = 2.0 * depth - 1.0;
  return texel_of_moments(vec4(z, z * z, z * z * z, z * z * z * z));
}
#include "renderer/shadow_maps/blurred_map.frag"
