// Writing a finished pixel.
#ifndef PENUMBRA_PIXEL_OUTPUT_GLSL
#define PENUMBRA_PIXEL_OUTPUT_GLSL
#include "renderer/shaders/encoding.glsl"

layout(location = 0) out vec4 out_encoded;
#ifdef WITH_LINEAR
layout(location = 1) out vec4 out_linear;
#endif

// `sum` of linear light, which `scale` brings to the picture's exposure.
void write_pixel(vec3 sum, float scale) {
  vec3 color = scale * sum;
#ifdef WITH_LINEAR
  out_linear = vec4(color, 1.0);
#endif
  // Some devices blend what is infinite to the greatest float, 3.4e38.
  out_encoded = encoded(color, all(lessThan(abs(sum), vec3(1e37))));
}
#endif
