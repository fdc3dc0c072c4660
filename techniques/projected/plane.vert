// Corners of casters, thrown onto a receiver's plane from the light, as the camera sees them there.
#include "renderer/shaders/caster.glsl"
#include "techniques/projected/receiver.glsl"

layout(location = 0) in vec3 position;
#ifdef MASKED
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;
layout(location = 1) out vec2 surface_uv;
layout(location = 2) out float vertex_alpha;
#endif
layout(location = 0) out float height;  // of the caster above the plane, m

void main() {
  height = dot(receiver.plane.xyz, position) - receiver.plane.w;
#ifdef MASKED
  surface_uv = uv;
  vertex_alpha = color.a;
#endif
  gl_Position = receiver.clip_from_caster * vec4(position, 1.0);
  // No depth is tested, and neither the near plane nor a far one may cut a shadow off.
  gl_Position.z = 0.0;
}
