// Corners of casters, thrown onto a receiver's plane from the light, as the camera sees them there.
#include "renderer/shaders/caster.glsl"
#include "techniques/projected/receiver.glsl"

layout(location = 0) in vec3 position;
layout(location = 0) out float height;  // of the caster above the plane, m

void main() {
  height = dot(receiver.plane.xyz, position) - receiver.plane.w;
  pass_holes();
  gl_Position = receiver.clip_from_caster * vec4(position, 1.0);
  // No depth is tested, and neither the near plane nor a far one may cut a shadow off.
  gl_Position.z = 0.0;
}
