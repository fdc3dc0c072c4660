// One triangle that covers the target, at infinity, in a colour that is the same everywhere and so encoded
// here: the sky's (SKY), or that of surfaces without light.
#include "renderer/shaders/encoding.glsl"

layout(location = 0) flat out vec3 linear;
layout(location = 1) flat out vec4 picture;

void main() {
  vec2 corner = vec2(gl_VertexIndex << 1 & 2, gl_VertexIndex & 2);
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
#ifdef SKY
  linear = frame.size.w * frame.background_low.rgb;
#else
  linear = vec3(0.0);
#endif
  picture = encoded(linear, true);
}
