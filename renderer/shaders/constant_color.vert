// A colour that is the same everywhere and so encoded here: the sky's (SKY), or that of surfaces without light.
#include "renderer/shaders/encoding.glsl"
#include "renderer/shaders/full_screen.glsl"

layout(location = 0) flat out vec3 linear;
layout(location = 1) flat out vec4 picture;

void main() {
  gl_Position = full_screen_corner();
#ifdef SKY
  linear = frame.size.w * frame.background_low.rgb;
#else
  linear = vec3(0.0);
#endif
  picture = encoded(linear, true);
}
