// Reading a linear depth map: where a receiver lies on it, and comparisons texel by texel.
#ifndef PENUMBRA_DEPTH_MAP_GLSL
#define PENUMBRA_DEPTH_MAP_GLSL
#include "renderer/shaders/shader_types.h"

layout(std140) uniform MapBlock { MapData map; };

/// A receiver on the map.
struct MapPoint {
  int face;        // -1: outside the map, lit
  vec2 texel;      // place in texels, 0 .. map size
  float distance;  // m along the face's axis, bias applied
  vec3 position;   // world, moved where the strategy moves it
  vec3 normal;     // of the receiver's plane
};

int face_of(vec3 offset) {
  if (int(map.range.w) == 1) return 0;
  vec3 size = abs(offset);
  if (size.x >= size.y && size.x >= size.z) return offset.x > 0.0 ? 0 : 1;
  if (size.y >= size.z) return offset.y > 0.0 ? 2 : 3;
  return offset.z > 0.0 ? 4 : 5;
}

/// World size of a texel at this distance along the axis, m.
float texel_size(int face, float distance) {
  return map.texel.y * (map.faces[face].origin.w > 0.5 ? distance : 1.0);
}

MapPoint locate(ShadowQuery query) {
  MapPoint point;
  point.face = face_of(query.position - map.faces[0].origin.xyz);
  point.position = query.position;
  point.normal = query.normal;
  MapFace face = map.faces[point.face];
  if (parameter_bias_strategy == bias_strategy_normal_offset) {
    // Far enough along the normal to clear the texels of the kernel on the receiver's own plane.
    float distance = dot(query.position - face.origin.xyz, face.forward.xyz);
    float cosine = clamp(dot(query.normal, query.to_light), 0.0, 1.0);
    float reach = 1.41421356 * (0.5 + map.filter_size.x) * texel_size(point.face, distance);
    point.position += query.normal * (map.texel.w * reach * sqrt(1.0 - cosine * cosine));
  }
  vec4 clip = face.clip_from_world * vec4(point.position, 1.0);
  point.texel = (0.5 + 0.5 * clip.xy / clip.w) * map.texel.x;
  point.distance = dot(point.position - face.origin.xyz, face.forward.xyz);
  if (clip.w <= 0.0 || any(lessThan(point.texel, vec2(0.0))) ||
      any(greaterThan(point.texel, vec2(map.texel.x))))
    point.face = -1;
  return point;
}

/// Distance along the axis at which the ray through a place on the map meets the receiver's plane.
float plane_distance(MapPoint point, vec2 texel) {
  MapFace face = map.faces[point.face];
  vec2 ab = 2.0 * texel / map.texel.x - 1.0;
  vec3 across = ab.x * face.right.xyz + ab.y * face.up.xyz;
  float height = dot(point.normal, point.position - face.origin.xyz);
  float met = face.origin.w > 0.5
                  ? height / dot(point.normal, face.forward.xyz + across)
                  : (height - dot(point.normal, across)) / dot(point.normal, face.forward.xyz);
  // A plane seen edge-on is not followed to infinity.
  float limit = 10.0 * (1.0 + map.filter_size.x) * texel_size(point.face, point.distance) * map.texel.w;
  return clamp(met, point.distance - limit, point.distance + limit);
}

/// Receiver's depth to compare with a texel of the map, in the map's units.
float receiver_depth(MapPoint point, vec2 texel_center) {
  float distance = point.distance;
  if (parameter_bias_strategy == bias_strategy_receiver_plane) distance = plane_distance(point, texel_center);
  return (distance - map.range.x) * map.range.z;
}
#endif
