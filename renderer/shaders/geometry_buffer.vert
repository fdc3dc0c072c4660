#include "renderer/shaders/frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
layout(location = 2) out vec2 surface_uv;
layout(location = 3) out vec4 vertex_color;

// Caps of shadow volumes must come to the same depth.
invariant gl_Position;

void main() {
  world_position = position;
  world_normal = normal;
  surface_uv = uv;
  vertex_color = color;
  gl_Position = frame.clip_from_world * vec4(position, 1.0);
}
