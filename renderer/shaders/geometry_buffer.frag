// Every 4 x 4 pixels that a triangle touches run this on lavapipe: what a triangle has in common comes packed
// from the vertex stage, and what a pixel needs once is left to those who read the buffer.
#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/geometry_buffer.glsl"
#include "renderer/shaders/surface_color.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 2) flat in uvec4 facet_words;
#ifdef COLOR_VARIES
layout(location = 3) in vec2 surface_uv;
layout(location = 4) in vec4 vertex_color;
layout(location = 5) flat in vec4 material_color;
#ifdef MASKED
layout(location = 6) flat in float alpha_cutoff;
#endif
#endif
#ifdef EMISSIVE
layout(location = 7) flat in vec3 emitted;
#endif

layout(location = 0) out vec4 out_position;
layout(location = 1) out uvec4 out_words;
#ifdef EMISSIVE
layout(location = 2) out vec4 out_emitted;
#endif

#ifdef TEXTURED
uniform sampler2D surface_texture;
#endif

void main() {
  uvec4 words = facet_words;
#ifdef COLOR_VARIES
  vec4 color = material_color * vertex_color;
#ifdef TEXTURED
  vec4 texel = texture(surface_texture, surface_uv);
#ifdef TEXTURES_AS_STORED
  texel.rgb = srgb_from_linear(texel.rgb);
#endif
  color *= texel;
#endif
#ifdef MASKED
  if (color.a < alpha_cutoff) discard;
#endif
  words.z = pack_color(decoded(color.rgb));
#endif
  pack_surface(words, world_position, world_normal, !gl_FrontFacing, out_position, out_words);
#ifdef EMISSIVE
  out_emitted = vec4(emitted, 1.0);
#endif
}
