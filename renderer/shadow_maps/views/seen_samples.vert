#include "renderer/shaders/caster.glsl"

layout(std140) uniform SeenBlock {
  mat4 clip_from_world;
}
seen;

layout(location = 0) in vec3 position;
#ifdef MASKED
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;
layout(location = 1) out vec2 surface_uv;
layout(location = 2) out float vertex_alpha;
#endif
layout(location = 0) out vec3 world_position;

void main() {
  world_position = position;
#ifdef MASKED
  surface_uv = uv;
  vertex_alpha = color.a;
#endif
  gl_Position = seen.clip_from_world * vec4(position, 1.0);
}
