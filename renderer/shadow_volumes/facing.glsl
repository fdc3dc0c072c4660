// Where the shadow of a corner goes.
#ifndef PENUMBRA_FACING_GLSL
#define PENUMBRA_FACING_GLSL
#include "renderer/shadow_volumes/light_side.glsl"

// Plane before which everything lies that can be in shadow: xyz unit away from the light, w distance
// from the light (from the origin for a directional one). All zero: volumes end at infinity.
layout(push_constant) uniform VolumeBlock {
  vec4 end_plane;
  float reach;          // m: length of a shadow taken as infinite where the view is parallel
  uint every_triangle;  // 0: the triangles are closed meshes, and those turned from the light cast
  float far_depth;      // where far_clip.frag cuts volumes off
} volume;

bool has_end_plane() { return any(notEqual(volume.end_plane.xyz, vec3(0.0))); }

// Where a shadow without an end ends that goes `along`, of that length.
vec4 endless_shadow(vec3 from, vec3 along, float length_along) {
  bool has_perspective = frame.camera_position.w > 0.5;
  vec4 at_reach = vec4(from + along * (volume.reach / length_along), 1.0);
  return mix(at_reach, vec4(along, 0.0), bvec4(has_perspective));
}

// Where the shadow of a corner ends: homogeneous, w 0 at infinity.
vec4 end_of_shadow(vec3 corner) {
  vec3 along = vector_from_light(corner);
  float from = dot(corner - light_origin(), volume.end_plane.xyz);
  float speed = dot(along, volume.end_plane.xyz);
  vec4 at_plane = vec4(corner + along * max((volume.end_plane.w - from) / speed, 0.0), 1.0);
  vec4 endless = endless_shadow(corner, along, max(length(along), 1e-30));
  return mix(endless, at_plane, bvec4(has_end_plane()));
}
#endif
