// How many texels of the map a pixel of the picture covers.
#ifndef PENUMBRA_MAP_FOOTPRINT_GLSL
#define PENUMBRA_MAP_FOOTPRINT_GLSL
#include "renderer/shadow_maps/depth_map.glsl"

/// From the receiver to where the camera's ray through a place of the frame meets the plane through it.
/// Without differences of positions, which a distant camera or a near plane close to it would spoil.
vec3 step_on_plane(ShadowQuery query, vec2 pixels) {
  vec2 step = 2.0 * pixels / frame.size.xy;
  vec3 across = (frame.world_from_clip * vec4(step, 0.0, 0.0)).xyz;
  if (frame.camera_position.w < 0.5) {
    vec3 along = frame.camera_direction.xyz;
    return across - along * dot(query.normal, across) / dot(query.normal, along);
  }
  // Of clip space, z 0 and w 1 are the ray's direction at unit depth.
  vec3 along = (frame.world_from_clip * vec4(2.0 * query.pixel / frame.size.xy - 1.0, 0.0, 1.0)).xyz;
  float facing = dot(query.normal, along);
  float slope = dot(query.normal, across);
  float depth = dot(query.position - frame.camera_position.xyz, along) / dot(along, along);
  return depth * (facing * across - slope * along) / (facing + slope);
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
