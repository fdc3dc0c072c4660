// Caps on the camera's near plane: the triangles that throw volumes, thrown onto it from the light. What
// they cover there starts inside that many volumes (Hornus, Hoberock, Lefebvre and Hart 2005, ZP+).
#include "renderer/shadow_volumes/silhouette.glsl"

layout(triangle_strip, max_vertices = 3) out;

layout(std140) uniform NearPlaneBlock { mat4 near_from_caster; };

void main() {
  bool lit;
  if (!throws_volume(lit)) return;
  for (int k = 0; k < 3; ++k) {
    gl_Position = near_from_caster * vec4(world_position[k * stride], 1.0);
    EmitVertex();
  }
  EndPrimitive();
}
