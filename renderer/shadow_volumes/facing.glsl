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

// Where the shadow of a corner ends: homogeneous, w 0 at infinity.
vec4 end_of_shadow(vec3 corner) {
  vec3 along = vector_from_light(corner);
  if (volume.end_plane.xyz != vec3(0.0)) {
    float from = dot(corner - light_origin(), volume.end_plane.xyz);
    float speed = dot(along, volume.end_plane.xyz);
    return vec4(corner + along * max((volume.end_plane.w - from) / speed, 0.0), 1.0);
  }
  if (frame.camera_position.w > 0.5) return vec4(along, 0.0);
  return vec4(corner + along * (volume.reach / max(length(along), 1e-30)), 1.0);
}
#endif
