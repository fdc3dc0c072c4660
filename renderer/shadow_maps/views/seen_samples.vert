#include "renderer/shaders/caster.glsl"

layout(std140) uniform SeenBlock {
  mat4 clip_from_world;
}
seen;

layout(location = 0) in vec3 position;
layout(location = 0) out vec3 world_position;

void main() {
  world_position = position;
  pass_holes();
  gl_Position = seen.clip_from_world * vec4(position, 1.0);
}
