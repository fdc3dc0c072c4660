// How many texels of the map a pixel of the picture covers.
#ifndef PENUMBRA_MAP_FOOTPRINT_GLSL
#define PENUMBRA_MAP_FOOTPRINT_GLSL
#include "renderer/shadow_maps/depth_map.glsl"

/// From the receiver to where the camera's ray, so many pixels further, meets the plane through it. Not the
/// difference of two such places, which a distant camera or a near plane close to it would spoil.
vec3 step_on_plane(ShadowQuery query, vec2 pixels) {
  vec3 along = frame.camera_direction.xyz;
  vec3 right = frame.pixel.xyz;
  vec3 across = pixels.x * right + pixels.y * cross(along, right);
  float slope = dot(query.normal, across);
  if (frame.camera_position.w < 0.5) return across - along * (slope / dot(query.normal, along));
  vec3 from_camera = query.position - frame.camera_position.xyz;
  float height = dot(query.normal, from_camera);
  return (height * across - slope * from_camera) * (1.0 / (height / dot(along, from_camera) + slope));
}

vec2 texel_seen_at(ShadowQuery query, int view, vec2 pixels) {
  return place_on_view(view, query.position + step_on_plane(query, pixels)).xy;
}

/// Steps on the map, in texels, for a step of one pixel to the right (xy) and down (zw). From the
/// receiver's plane: differences between neighbouring pixels are garbage across depth edges.
vec4 map_footprint(ShadowQuery query, MapPoint point) {
  const vec2 right = vec2(0.5, 0.0), down = vec2(0.0, 0.5);
  return vec4(texel_seen_at(query, point.view, right) - texel_seen_at(query, point.view, -right),
              texel_seen_at(query, point.view, down) - texel_seen_at(query, point.view, -down));
}

/// Width of the square of texels that a pixel covers, its longer side as a mip chain has it.
float footprint_width(vec4 footprint) { return max(length(footprint.xy), length(footprint.zw)); }
#endif
