// How many texels of the map a pixel of the picture covers.
#ifndef PENUMBRA_MAP_FOOTPRINT_GLSL
#define PENUMBRA_MAP_FOOTPRINT_GLSL
#include "renderer/shadow_maps/depth_map.glsl"

/// Where the camera's ray through a place of the frame meets the plane through the receiver.
vec3 plane_seen_at(ShadowQuery query, vec2 pixel) {
  vec4 near = frame.world_from_clip * vec4(2.0 * pixel / frame.size.xy - 1.0, 1.0, 1.0);
  vec3 start = near.xyz / near.w;
  vec3 direction = frame.camera_position.w > 0.5 ? start - frame.camera_position.xyz
                                                 : frame.camera_direction.xyz;
  return start + direction * dot(query.normal, query.position - start) / dot(query.normal, direction);
}

vec2 texel_seen_at(ShadowQuery query, int face, vec2 pixel) {
  vec4 clip = map.faces[face].clip_from_world * vec4(plane_seen_at(query, pixel), 1.0);
  return (0.5 + 0.5 * clip.xy / clip.w) * map.texel.x;
}

/// Steps on the map, in texels, for a step of one pixel to the right (xy) and down (zw). From the
/// receiver's plane: differences between neighbouring pixels are garbage across depth edges.
vec4 map_footprint(ShadowQuery query, MapPoint point) {
  const vec2 right = vec2(0.5, 0.0), down = vec2(0.0, 0.5);
  return vec4(texel_seen_at(query, point.face, query.pixel + right) -
                  texel_seen_at(query, point.face, query.pixel - right),
              texel_seen_at(query, point.face, query.pixel + down) -
                  texel_seen_at(query, point.face, query.pixel - down));
}

/// Width of the square of texels that a pixel covers, its longer side as a mip chain has it.
float footprint_width(vec4 footprint) { return max(length(footprint.xy), length(footprint.zw)); }
#endif
