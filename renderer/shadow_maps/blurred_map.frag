// One direction of a separable blur over a map: columns of what was blurred along rows. A stage that
// defines ENCODE and vec4 encode_depth(float) before it reads and encodes rows of the depth map.
#ifdef ENCODE
uniform sampler2DArray shadow_map;
const ivec2 direction = ivec2(1, 0);
#else
uniform sampler2DArray blurred_rows;
const ivec2 direction = ivec2(0, 1);
#endif

layout(push_constant) uniform BlurBlock { uint face; } blur;

layout(location = 0) out vec4 out_value;

float weight(int offset) {
  if (parameter_blur_filter == blur_filter_box || parameter_blur == 0) return 1.0;
  float deviations = 2.0 * float(offset) / float(parameter_blur);
  return exp(-0.5 * deviations * deviations);
}

// Texels beyond the border repeat it.
vec4 value_at(ivec2 texel) {
#ifdef ENCODE
  ivec2 last = textureSize(shadow_map, 0).xy - 1;
  return encode_depth(texelFetch(shadow_map, ivec3(clamp(texel, ivec2(0), last), int(blur.face)), 0).r);
#else
  ivec2 last = textureSize(blurred_rows, 0).xy - 1;
  return texelFetch(blurred_rows, ivec3(clamp(texel, ivec2(0), last), int(blur.face)), 0);
#endif
}

void main() {
  vec4 sum = vec4(0.0);
  float total = 0.0;
  for (int i = -parameter_blur; i <= parameter_blur; ++i) {
    float share = weight(i);
    sum += share * value_at(ivec2(gl_FragCoord.xy) + i * direction);
    total += share;
  }
  out_value = sum / total;
}
