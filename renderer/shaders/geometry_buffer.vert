#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/geometry_buffer.glsl"
#include "renderer/shaders/surface_color.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;
layout(location = 4) in vec3 facet;  // of the triangle that has its first corner here

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
layout(location = 2) flat out uvec4 facet_words;
#ifdef COLOR_VARIES
layout(location = 3) out vec2 surface_uv;
layout(location = 4) out vec4 vertex_color;
layout(location = 5) flat out vec4 material_color;
#ifdef MASKED
layout(location = 6) flat out float alpha_cutoff;
#endif
#endif
#ifdef EMISSIVE
layout(location = 7) flat out vec3 emitted;
#endif

// Caps of shadow volumes must come to the same depth.
invariant gl_Position;

void main() {
  world_position = position;
  world_normal = normal;
#ifdef COLOR_VARIES
  surface_uv = uv;
  vertex_color = color;
#endif
  MaterialData material = materials[draw.material];
#ifdef COLOR_VARIES
  material_color = material.base_color;
#ifdef MASKED
  alpha_cutoff = material.surface.z;
#endif
#endif
#ifdef EMISSIVE
  emitted = material.emissive.rgb;
#endif
  facet_words = pack_facet(facet, decoded(material.base_color.rgb), material.surface.x, material.surface.y);
  gl_Position = frame.clip_from_world * vec4(position, 1.0);
}
