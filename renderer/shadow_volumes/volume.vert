// Corners of casters, in the world and in the picture. The position is computed as the geometry
// buffer computes it, so that a cap lies at the very depth of the triangle that it closes.
#include "renderer/shaders/frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 0) out vec3 world_position;

invariant gl_Position;

void main() {
  world_position = position;
  gl_Position = frame.clip_from_world * vec4(position, 1.0);
}
