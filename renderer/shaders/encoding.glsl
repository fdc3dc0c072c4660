// A pixel as the picture stores it.
#ifndef PENUMBRA_ENCODING_GLSL
#define PENUMBRA_ENCODING_GLSL
#include "renderer/shaders/frame.glsl"

// Of linear light with exposure. What is no number is shown as magenta, which no scene contains, and has an
// alpha of 0, by which the frame counts it.
vec4 encoded(vec3 color, bool finite) {
  bool encode = frame.pixel.w > 0.5;
  color = clamp(color, 0.0, 1.0);
  return finite ? vec4(encode ? srgb_from_linear(color) : color, 1.0) : vec4(1.0, 0.0, 1.0, 0.0);
}
#endif
