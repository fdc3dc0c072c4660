// Caps of open meshes, at their own triangles. They lie in surfaces that may be lit, so they must have
// the very depth of the geometry buffer, to the last bit. A geometry shader does not promise that: some
// drivers move corners from clip space into the picture by other code behind one. So these come without,
// by the plain way that the geometry buffer takes, in its order of corners but for the swap of the last
// two that turns a triangle over, which leaves depths alone.
#include "renderer/shadow_volumes/light_side.glsl"

uniform usamplerBuffer adjacency_indices;  // six a triangle, corners at the even places
uniform samplerBuffer caster_positions;    // three floats each, world

invariant gl_Position;

vec3 corner_of(int triangle, int corner) {
  int first = 3 * int(texelFetch(adjacency_indices, 6 * triangle + 2 * corner).r);
  return vec3(texelFetch(caster_positions, first).r, texelFetch(caster_positions, first + 1).r,
              texelFetch(caster_positions, first + 2).r);
}

void main() {
  int triangle = gl_VertexIndex / 3;
  vec3 corners[3] = vec3[3](corner_of(triangle, 0), corner_of(triangle, 1), corner_of(triangle, 2));
  int corner = gl_VertexIndex % 3;
  int side = light_side(corners[0], corners[1], corners[2]);
  if (side < 0) corner = (3 - corner) % 3;
  if (side == 0) corner = 0;  // throws no volume: nothing is covered
  gl_Position = frame.clip_from_world * vec4(corners[corner], 1.0);
}
