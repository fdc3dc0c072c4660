// Reading a depth map: where a receiver lies on it, and comparisons texel by texel.
//
// Filters never touch the map's image: they call locate, then compare_texel or fetch_depth with whole
// texels near the place found. Another layout plugs in here, chosen by the constant parameter_layout:
//   - locate fills a MapPoint: which view (a face here; a cascade or a tile elsewhere), the place in
//     texels of that view, and the receiver's plane as a ratio of two
//     functions that are affine in texels, which any projective view has, warped ones included;
//   - fetch_depth answers the stored depth of a texel of that view (from an image here; from a storage
//     buffer elsewhere, where no sampler reaches), 0 at near and 1 at far;
//   - receiver_depth turns metres into those units, distance_of_depth turns them back.
// Only filter hardware-bilinear reads the image itself, so it serves layouts that are one image.
#ifndef PENUMBRA_DEPTH_MAP_GLSL
#define PENUMBRA_DEPTH_MAP_GLSL
#include "renderer/shaders/shadow_query.glsl"
#include "renderer/shadow_maps/depth_coding.glsl"

uniform sampler2DArray shadow_map;

/// A receiver on the map.
struct MapPoint {
  int face;            // view of the map; -1: outside it, lit
  vec2 texel;          // place in texels, 0 .. map size
  float distance;      // m along the view's axis
  float texel_width;   // m at that distance
  float grant;         // m that every comparison leaves to the receiver
  float nearest;       // m: no comparison follows the receiver's plane beyond
  vec3 plane_top;      // the receiver's plane meets the ray through texel + d at a distance of
  vec3 plane_bottom;   // dot(plane_top, (d, 1)) / dot(plane_bottom, (d, 1)) m
};

int face_of(vec3 offset) {
  if (int(map.range.w) == 1) return 0;
  vec3 size = abs(offset);
  if (size.x >= size.y && size.x >= size.z) return offset.x > 0.0 ? 0 : 1;
  if (size.y >= size.z) return offset.y > 0.0 ? 2 : 3;
  return offset.z > 0.0 ? 4 : 5;
}

/// World size of a texel at this distance along the axis, m.
float texel_size(MapFace face, float distance) {
  return face.forward.w * (face.origin.w > 0.5 ? distance : 1.0);
}

/// How far the nearest texel's centre may be, in texels, from a place that a filter reaches.
float texel_reach(float kernel_radius) { return 1.41421356 * (0.5 + kernel_radius); }

/// What the receiver is granted in every comparison, in widths of a texel. The map itself was moved by
/// the constant bias and, with strategy slope, by the slope of its casters; with those that know two
/// surfaces, towards the second.
float granted_texels(float kernel_radius) {
  // What a facet at 45 degrees spans over the kernel.
  if (parameter_bias_strategy == bias_strategy_constant) return 0.5 + kernel_radius;
  // The receiver's plane is known, but bent surfaces leave it. Half a texel and a quarter of the radius
  // make as many pixels too dark as too bright on the survey's scenes.
  if (parameter_bias_strategy == bias_strategy_normal_offset ||
      parameter_bias_strategy == bias_strategy_receiver_plane ||
      parameter_bias_strategy == bias_strategy_auto)
    return 0.5 + 0.25 * kernel_radius;
  return 0.0;
}

/// `kernel_radius` in texels is how far the filter reads from the receiver's place.
MapPoint locate(ShadowQuery query, float kernel_radius) {
  MapPoint point;
  point.face = face_of(query.position - map.faces[0].origin.xyz);
  MapFace face = map.faces[point.face];
  bool perspective = face.origin.w > 0.5;
  vec3 position = query.position;
  if (parameter_bias_strategy == bias_strategy_normal_offset) {
    // Along the normal until the receiver's own plane, and any convex body behind it, lies wholly
    // behind the moved point over every texel that the filter reads. A step d across the axis leaves
    // the plane by d sin(angle between normal and axis).
    float cosine = dot(query.normal, face.forward.xyz);
    float across = sqrt(max(1.0 - cosine * cosine, 0.0));
    float width = texel_size(face, dot(position - face.origin.xyz, face.forward.xyz));
    position += query.normal * (map.texel.w * texel_reach(kernel_radius) * width * across);
  }
  vec4 clip = face.clip_from_world * vec4(position, 1.0);
  point.texel = (0.5 + 0.5 * clip.xy / clip.w) * map.texel.x;
  point.distance = dot(position - face.origin.xyz, face.forward.xyz);
  point.texel_width = texel_size(face, point.distance);
  point.grant = map.texel.w * granted_texels(kernel_radius) * point.texel_width;
  point.nearest = 0.0;
  if (clip.w <= 0.0 || any(lessThan(point.texel, vec2(0.0))) ||
      any(greaterThan(point.texel, vec2(map.texel.x)))) {
    point.face = -1;
    return point;
  }
  // Rays of the view are origin + s (forward + a right + b up), or origin + s forward + a right + b up.
  vec2 gradient = 2.0 / map.texel.x *
                  vec2(dot(query.normal, face.right.xyz), dot(query.normal, face.up.xyz));
  float facing = dot(query.normal, face.forward.xyz);
  if (perspective) {
    float height = dot(query.normal, position - face.origin.xyz);
    point.plane_top = vec3(0.0, 0.0, height);
    point.plane_bottom = vec3(gradient, height / point.distance);
  } else {
    point.plane_top = vec3(-gradient, facing * point.distance);
    point.plane_bottom = vec3(0.0, 0.0, facing);
  }
  return point;
}

/// Where the ray through `offset` texels from the receiver's place meets the receiver's plane, m along
/// the axis; never farther than the receiver, so that a surface which rises before the plane (the
/// ground before a wall) is no occluder.
float plane_distance(MapPoint point, vec2 offset) {
  float top = dot(point.plane_top, vec3(offset, 1.0));
  float bottom = dot(point.plane_bottom, vec3(offset, 1.0));
  // A lit plane has a bottom below zero; where the ray misses it there is nothing to compare with.
  if (bottom >= 0.0) return point.distance;
  // A plane seen edge-on is not followed to infinity: normals of 16 bits do not bear it below 0.02 degrees.
  float steep = point.distance - 3000.0 * point.texel_width * length(offset);
  return clamp(top / bottom, max(steep, point.nearest), point.distance);
}

/// Metres along the axis in the map's units, and back.
float depth_of_distance(float distance) {
  return coded_depth((distance - map.range.x) * map.range.z);
}
float distance_of_depth(float depth) { return map.range.x + even_depth(depth) / map.range.z; }

/// The receiver's depth to compare with a texel of the map. Like casters, receivers behind far stand at
/// it, where the map was given a far of its own.
float receiver_depth(MapPoint point, ivec2 texel) {
  float distance = point.distance;
  // Maps of back faces need it where a body is thinner than its slope over a texel.
  if (parameter_bias_strategy == bias_strategy_receiver_plane ||
      parameter_bias_strategy == bias_strategy_auto ||
      parameter_bias_strategy == bias_strategy_back_faces) {
    float met = plane_distance(point, vec2(texel) + 0.5 - point.texel);
    distance += map.texel.w * (met - point.distance);
  }
  return min(depth_of_distance(distance - point.grant), 1.0);
}

/// Depth that the map holds; texels beyond the border repeat it.
float fetch_depth(MapPoint point, ivec2 texel) {
  texel = clamp(texel, ivec2(0), ivec2(int(map.texel.x) - 1));
  return texelFetch(shadow_map, ivec3(texel, point.face), 0).r;
}

/// 1 where the texel leaves the receiver lit, else 0.
float compare_texel(MapPoint point, ivec2 texel) {
  return receiver_depth(point, texel) <= fetch_depth(point, texel) ? 1.0 : 0.0;
}
#endif
