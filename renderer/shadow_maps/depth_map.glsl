// Reading a depth map: which views show a receiver, where it lies on them, and comparisons texel by
// texel.
//
// The layout (renderer/shadow_maps/layouts) chooses views, and a technique says what one view tells:
// every program that includes this defines
//   float filter_view(ShadowQuery query, int view);   // 1 lit, 0 occluded
// Filters call locate, then compare_texel or fetch_depth with whole texels near the place found.
#ifndef PENUMBRA_DEPTH_MAP_GLSL
#define PENUMBRA_DEPTH_MAP_GLSL
#include "renderer/shaders/shadow_query.glsl"
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/bias/strategies.glsl"
#include "renderer/shadow_maps/texels/depth_coding.glsl"

#ifdef ONE_VIEW
int view_count() { return 1; }
#else
int view_count() { return int(map.texel.z); }
#endif

/// Texels along a side of a view.
float view_size(int view) { return map_view(view).texels.x; }

/// The views that tell of a receiver, as the layout chooses them.
struct ViewChoice {
  int first;    // -1: none, so that it is lit
  int second;   // where share is not 0
  float share;  // of what the second tells, from 0 to 1
};

/// Place on a view in texels, 0 to the view's size; w as the view's clip matrix has it, above 0 before
/// the light.
vec3 place_on_view(int view, vec3 position) {
  vec4 clip = map_view(view).clip_from_world * vec4(position, 1.0);
  return vec3((0.5 + 0.5 * clip.xy / clip.w) * view_size(view), clip.w);
}

bool is_on_view(int view, vec3 position) {
  vec3 place = place_on_view(view, position);
  return place.z > 0.0 && all(greaterThanEqual(place.xy, vec2(0.0))) &&
         all(lessThanEqual(place.xy, vec2(view_size(view))));
}

// Defines ViewChoice choose_views(vec3 position).
#include "renderer/shadow_maps/chosen_layout.glsl"

float filter_view(ShadowQuery query, int view);

float calculate_shadow(ShadowQuery query) {
  ViewChoice choice = choose_views(query.position);
  if (choice.first < 0) return 1.0;
#ifdef ONE_VIEW
  return filter_view(query, 0);
#else
  // One call in a loop: with two calls drivers would compile the filter twice.
  int views = choice.share > 0.0 ? 2 : 1;
  float lit = 0.0;
  for (int i = 0; i < views; ++i) {
    float own = filter_view(query, i == 0 ? choice.first : choice.second);
    lit = i == 0 ? own : mix(lit, own, choice.share);
  }
  return lit;
#endif
}

/// A receiver on the map.
struct MapPoint {
  int view;            // of the map
  vec2 texel;          // place in texels, 0 .. the view's size
  float distance;      // m along the view's axis
  Spread spread;       // of the texels there
  float texel_width;   // m, of the widest there
  float grant;         // m that every comparison leaves to the receiver
  vec4 range;          // of the view
  float nearest;       // m: no comparison follows the receiver's plane beyond
  vec3 plane_top;      // the receiver's plane meets the ray through texel + d at a distance of
  vec3 plane_bottom;   // dot(plane_top, (d, 1)) / dot(plane_bottom, (d, 1)) m
};

/// How far the nearest texel's centre may be, in texels, from a place that a filter reaches.
float texel_reach(float kernel_radius) { return 1.41421356 * (0.5 + kernel_radius); }

/// A function dot(f, (d, 1)) of steps on the unwarped map as one of steps in texels; ratios of two
/// such stay what they are.
vec3 over_texels(Spread spread, vec3 f) {
  return vec3(f.xy * spread.texels + spread.lean * f.z, f.z);
}

/// Where a view shows the receiver. `kernel_radius` in texels is how far the filter reads from there.
MapPoint locate(ShadowQuery query, int view_index, float kernel_radius) {
  MapPoint point;
  point.view = view_index;
  MapView view = map_view(view_index);
  point.range = view.range;
  bool perspective = view.origin.w > 0.5;
  vec3 position = query.position;
  if (moves_along_normal()) {
    // Along the normal until the receiver's own plane, and any convex body behind it, lies wholly
    // behind the moved point over every texel that the filter reads. A step d across the axis leaves
    // the plane by d sin(angle between normal and axis).
    float cosine = dot(query.normal, view.forward.xyz);
    float across = sqrt(max(1.0 - cosine * cosine, 0.0));
    float width = texel_size(view, dot(position - view.origin.xyz, view.forward.xyz)) *
                  widest_texel(spread_at(view, place_on_view(view_index, position).xy));
    position += query.normal * (map.texel.w * texel_reach(kernel_radius) * width * across);
  }
  point.texel = place_on_view(view_index, position).xy;
  point.distance = dot(position - view.origin.xyz, view.forward.xyz);
  point.spread = spread_at(view, point.texel);
  point.texel_width = texel_size(view, point.distance) * widest_texel(point.spread);
  point.grant = map.texel.w * granted_texels(kernel_radius) * point.texel_width;
  point.nearest = 0.0;
  // Rays of the view are origin + s (forward + a right + b up), or origin + s forward + a right + b up.
  vec2 gradient = 2.0 / view_size(view_index) *
                  vec2(dot(query.normal, view.right.xyz), dot(query.normal, view.up.xyz));
  float facing = dot(query.normal, view.forward.xyz);
  if (perspective) {
    // The light's height over the plane, and what the plane's distance is counted from.
    float moved = view.right.w;
    float height = dot(query.normal, position - view.origin.xyz) + moved * facing;
    point.plane_bottom = vec3(gradient, height / from_light(view, point.distance));
    point.plane_top = vec3(-moved * gradient, moved > 0.0 ? point.distance * point.plane_bottom.z : height);
  } else {
    point.plane_top = vec3(-gradient, facing * point.distance);
    point.plane_bottom = vec3(0.0, 0.0, facing);
  }
  point.plane_top = over_texels(point.spread, point.plane_top);
  point.plane_bottom = over_texels(point.spread, point.plane_bottom);
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
  // A plane seen edge-on is not followed to infinity, but as far as light of 0.02 degrees needs.
  float steep = point.distance - 3000.0 * point.texel_width * length(offset);
  return clamp(top / bottom, max(steep, point.nearest), point.distance);
}

/// Metres along the axis in the view's units, and back.
float depth_of_distance(MapPoint point, float distance) {
  return coded_depth(point.range, even_depth_of(point.range, distance));
}
float distance_of_depth(MapPoint point, float depth) {
  return point.range.x + even_depth(point.range, depth) / point.range.z;
}

#ifdef TEXELS_IN_BUFFER
#include "renderer/shadow_maps/texels/tile_texels.glsl"
#else
uniform sampler2DArray shadow_map;

/// Depth that the map holds; texels beyond the border repeat it.
float fetch_depth(MapPoint point, ivec2 texel) {
  return texel_nearest_to(shadow_map, ivec3(texel, point.view), ivec2(map.texel.x)).r;
}

/// Middle of what a read of a texel finds.
vec2 texel_center(MapPoint point, ivec2 texel) { return vec2(texel) + 0.5; }

/// What a comparison with a texel grants, m.
float texel_grant(MapPoint point, ivec2 texel) { return point.grant; }
#endif

/// The receiver's depth to compare with a texel of the map. Like casters, receivers behind far stand at
/// it, where the map was given a far of its own.
float receiver_depth(MapPoint point, ivec2 texel) {
  float distance = point.distance;
  if (compares_with_plane()) {
    float met = plane_distance(point, texel_center(point, texel) - point.texel);
    distance += map.texel.w * (met - point.distance);
  }
  return min(depth_of_distance(point, distance - texel_grant(point, texel)), 1.0);
}

/// 1 where the texel leaves the receiver lit, otherwise 0.
float compare_texel(MapPoint point, ivec2 texel) {
  return receiver_depth(point, texel) <= fetch_depth(point, texel) ? 1.0 : 0.0;
}
#endif
