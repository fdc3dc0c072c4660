// Which side of a triangle the light is on, and where a corner's shadow goes.
#ifndef PENUMBRA_FACING_GLSL
#define PENUMBRA_FACING_GLSL
#include "renderer/shaders/frame.glsl"

layout(std140) uniform LightBlock { LightData light; };

bool is_before(vec3 a, vec3 b) {
  return a.x < b.x || (a.x == b.x && (a.y < b.y || (a.y == b.y && a.z < b.z)));
}

// Whether the light is on the side from which a, b, c runs counter-clockwise. Decided by the light's
// point against the triangle's own plane, not by a direction to one of its points, and with the
// corners sorted first: whoever asks, and in whatever order, gets the same bits, and a triangle is
// turned to the light exactly where its mirror image is not. So both sides of an edge always agree
// on whether it is a silhouette, and volumes have no gaps.
bool is_lit(vec3 a, vec3 b, vec3 c) {
  bool even = true;
  if (is_before(b, a)) { vec3 t = a; a = b; b = t; even = !even; }
  if (is_before(c, b)) { vec3 t = b; b = c; c = t; even = !even; }
  if (is_before(b, a)) { vec3 t = a; a = b; b = t; even = !even; }
  precise vec3 u = b - a;
  precise vec3 v = c - a;
  precise vec3 normal = vec3(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
  precise vec3 to_light = int(light.position.w) == light_kind_directional ? -light.direction.xyz
                                                                          : light.position.xyz - a;
  precise float height = normal.x * to_light.x + normal.y * to_light.y + normal.z * to_light.z;
  return (height >= 0.0) == even;
}

// Plane before which everything lies that can be in shadow: xyz unit away from the light, w distance
// from the light (from the origin for a directional one). All zero: volumes end at infinity.
layout(push_constant) uniform VolumeBlock {
  vec4 end_plane;
  float reach;          // m: length of a shadow that stands for infinity where the view is parallel
  uint every_triangle;  // 0: the triangles are closed meshes, and those turned from the light cast
} volume;

// Where the shadow of a corner ends: homogeneous, w 0 at infinity.
vec4 end_of_shadow(vec3 corner) {
  bool directional = int(light.position.w) == light_kind_directional;
  vec3 along = directional ? light.direction.xyz : corner - light.position.xyz;
  if (volume.end_plane.xyz != vec3(0.0)) {
    float from = dot(directional ? corner : along, volume.end_plane.xyz);
    float speed = dot(along, volume.end_plane.xyz);
    return vec4(corner + along * max((volume.end_plane.w - from) / speed, 0.0), 1.0);
  }
  if (frame.camera_position.w > 0.5) return vec4(along, 0.0);
  return vec4(corner + along * (volume.reach / max(length(along), 1e-30)), 1.0);
}
#endif
