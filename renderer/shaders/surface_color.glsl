// What is drawn and its colour, for both stages of the pass that fills the geometry buffer.
#include "renderer/shaders/frame.glsl"

layout(std430) readonly buffer MaterialBlock { MaterialData materials[]; };
layout(push_constant) uniform DrawBlock { uint material; } draw;

// Textures and materials arrive decoded once; the gamma parameter may ask for none or twice.
vec3 decoded(vec3 linear_color) {
#if DECODES == 0
  return srgb_from_linear(linear_color);
#elif DECODES == 2
  return linear_from_srgb(linear_color);
#else
  return linear_color;
#endif
}
