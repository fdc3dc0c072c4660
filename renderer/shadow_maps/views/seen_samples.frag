// Places that the camera sees; w is how far the surface may reach from there to the next sample, m,
// negative where it faces away from the light.
#include "renderer/shaders/caster.glsl"
#include "renderer/shaders/shadow_query.glsl"

layout(location = 0) in vec3 world_position;

layout(location = 0) out vec4 seen_position;

void main() {
  vec3 right = dFdx(world_position), down = dFdy(world_position);
  vec3 normal = cross(right, down);
  cut_holes();
  bool has_eye = frame.camera_position.w > 0.5;
  vec3 to_camera = mix(-frame.camera_direction.xyz, frame.camera_position.xyz - world_position, bvec3(has_eye));
  if (dot(normal, to_camera) < 0.0) normal = -normal;
  vec3 to_light = vector_to_light(world_position);
  // Normals of shading lean by a few degrees from those of facets.
  float away = -0.2 * length(normal) * length(to_light);
  float reach = max(length(right) + length(down), 1e-30);
  seen_position = vec4(world_position, dot(normal, to_light) >= away ? reach : -reach);
}
