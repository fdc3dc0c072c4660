#include "renderer/reference/occlusion_mask.glsl"
#include "renderer/shaders/texel.glsl"

#ifdef DRAW_DIAGNOSTIC
uniform sampler2DArray scramble_sums;  // by pixel: brightness that each of 16 scrambles saw

vec4 draw_diagnostic_uncertainty(ShadowQuery query, vec2 picture) {
  ivec2 pixel = ivec2(query.pixel) / int(frame.size.z);
  float sum = 0.0, squares = 0.0;
  for (int i = 0; i < scramble_count; ++i)
    sum += texel_of(scramble_sums, ivec3(pixel, i / 4))[i % 4];
  float mean = sum / float(scramble_count);
  for (int i = 0; i < scramble_count; ++i) {
    float deviation = texel_of(scramble_sums, ivec3(pixel, i / 4))[i % 4] - mean;
    squares += deviation * deviation;
  }
  float error = sqrt(squares / float(scramble_count * (scramble_count - 1)));
  float levels = 255.0 * frame.size.w * error;
  return vec4(vec3(clamp(1.0 + 0.1 * log2(max(levels, 1e-6)), 0.0, 1.0)), 1.0);
}
#endif
