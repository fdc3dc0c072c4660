#include "renderer/shadow_maps/diagnostics.glsl"
#include "renderer/shadow_maps/filters/percentage_closer.glsl"
#include "renderer/shadow_maps/filters/nearest_depths.glsl"

// The light's extent as the map sees it. A blocker at distance s along the axis hides the light from a
// receiver at distance d wherever it lies within reach(s, d) of the receiver's place, in units of
// `right` and `up`: those are the half sizes in texels, for an extent one metre across at a reach of 1.
struct ExtentOnMap {
  vec2 right;
  vec2 up;
  vec3 world_right;  // the half sizes in the world, m, of directional lights against a distance of 1
  vec3 world_up;
  bool square;  // rectangle; otherwise round
};

ExtentOnMap extent_on_map(MapPoint point) {
  MapView view = map_view(point.view);
  vec2 half_size = light_half_size();
  vec3 along_right = normalize(view.right.xyz);
  vec3 along_up = normalize(view.up.xyz);
  turn_to_extent(along_right, along_up);
  vec2 texels = 0.5 * view.texels.x /
                vec2(dot(view.right.xyz, view.right.xyz), dot(view.up.xyz, view.up.xyz));
  ExtentOnMap extent;
  extent.right = half_size.x * texels *
                 vec2(dot(along_right, view.right.xyz), dot(along_right, view.up.xyz));
  extent.up = half_size.y * texels * vec2(dot(along_up, view.right.xyz), dot(along_up, view.up.xyz));
  // A warp is followed as it is at the receiver.
  mat2 warp = inverse(point.spread.texels);
  extent.right = warp * extent.right;
  extent.up = warp * extent.up;
  extent.world_right = half_size.x * along_right;
  extent.world_up = half_size.y * along_up;
  extent.square = extent_is_square();
  return extent;
}

// Half the penumbra's width (d - s) w / s on the receiver (van Sambeek 2007, 2.2.5), seen from the
// light: divided by d, where a texel is one unit wide. Directional light: both without the division.
float reach(MapPoint point, float blocker) {
  float gap = max(point.distance - blocker, 0.0);
  MapView view = map_view(point.view);
  return view.origin.w > 0.5 ? gap / (from_light(view, blocker) * from_light(view, point.distance)) : gap;
}

float texels_of(ExtentOnMap extent, float reach) {
  return reach * max(length(extent.right), length(extent.up));
}

// Taps over the extent, from -1 to 1: a spiral on the disc, a lattice on the square.
struct Taps {
  float rotation;
  vec2 direction;  // of the spiral's next
};
Taps first_of_taps(float rotation) { return Taps(rotation, direction_of_first_tap(rotation)); }
Taps next_of_taps(Taps taps) { return Taps(taps.rotation, direction_of_next_tap(taps.direction)); }

// The i-th of n.
vec2 extent_tap(ExtentOnMap extent, Taps taps, int i, int n) {
  if (!extent.square) return length_of_tap(i, n) * taps.direction;
  float shift = taps.rotation * (0.5 / pi);
  vec2 place = vec2((float(i) + 0.5) * (1.0 / float(n)) + shift, float(i) * 0.61803399 + 1.7 * shift);
  return 2.0 * fract(place) - 1.0;
}

ivec2 texel_at(MapPoint point, ExtentOnMap extent, vec2 tap, float reach) {
  return ivec2(floor(point.texel + reach * (tap.x * extent.right + tap.y * extent.up)));
}

// How far casters that may block the light lie from the receiver's place: what is in a region
// bounds how wide the region need be, and so on until it shrinks no more.
float reach_of_casters(MapPoint point, ExtentOnMap extent) {
  float widest = reach(point, point.range.x);
  for (int round = 0; round < 4; ++round) {
    float nearest = distance_of_depth(point, nearest_depth(point, texels_of(extent, widest) + 1.0));
    widest = min(widest, reach(point, nearest));
  }
  return widest;
}

// Distance of what blocks the light, mean or nearest, m along the axis; below 0: nothing does.
float find_blocker(MapPoint point, ExtentOnMap extent, float rotation) {
  float slack = 1.0 / max(texels_of(extent, 1.0), 1e-20);  // of one texel
  float widest = max(reach_of_casters(point, extent), slack);
  float sum = 0.0;
  float count = 0.0;
  float nearest = 1e30;
  Taps taps = first_of_taps(rotation);
  for (int i = 0; i < parameter_search_taps; ++i, taps = next_of_taps(taps)) {
    // Every other tap is drawn to the middle, by the square of its share of the area: casters close to
    // the receiver may block only there, while others stand at the light and may block everywhere.
    vec2 tap = extent_tap(extent, taps, i, parameter_search_taps);
    float away = extent.square ? max(abs(tap.x), abs(tap.y)) : length_of_tap(i, parameter_search_taps);
    float drawn = (i & 1) == 1 ? away * away * away : 1.0;
    tap *= drawn;
    away *= drawn;
    ivec2 texel = texel_at(point, extent, tap, widest);
    float stored = fetch_depth(point, texel);
    if (receiver_depth(point, texel) <= stored) continue;
    float distance = distance_of_depth(point, stored);
    // A tap represents an area: the inverse of the taps' density there.
    away = max(away, 1e-4);
    float share = 1.0 / (1.0 + 0.25 * inversesqrt(away * away * away));
    sum += share * distance;
    count += share;
    nearest = min(nearest, distance);
  }
  if (count == 0.0) return -1.0;
  return parameter_blocker == blocker_nearest ? nearest : sum / count;
}

// What a tap represents: light from one place of the extent. Behind the receiver's own plane it does
// not reach it.
bool is_risen(ShadowQuery query, ExtentOnMap extent, vec2 tap) {
  vec3 to_light = query.to_light * extent_distance(query.light_distance);
  return dot(query.normal, to_light + tap.x * extent.world_right + tap.y * extent.world_up) > 0.0;
}

// Share of the extent that is over the receiver's horizon.
float risen_share(ShadowQuery query, ExtentOnMap extent, float rotation) {
  if (parameter_horizon == 0) return 1.0;
  float height = dot(query.normal, query.to_light) * extent_distance(query.light_distance);
  vec2 reach = abs(vec2(dot(query.normal, extent.world_right), dot(query.normal, extent.world_up)));
  if (height > reach.x + reach.y) return 1.0;
  float risen = 0.0;
  Taps taps = first_of_taps(rotation);
  for (int i = 0; i < parameter_taps; ++i, taps = next_of_taps(taps))
    risen += is_risen(query, extent, extent_tap(extent, taps, i, parameter_taps)) ? 1.0 : 0.0;
  return risen / float(parameter_taps);
}

float filter_view(ShadowQuery query, int view) {
  MapPoint point = locate(query, view, 0.5);
  // A light without extent casts no penumbra.
  if (!has_extent()) return mean_of_bilinear(point, 1);
  ExtentOnMap extent = extent_on_map(point);
  float rotation = tap_rotation(query.pixel);
  float risen = risen_share(query, extent, rotation);
  float blocker = find_blocker(point, extent, rotation);
  if (blocker < 0.0) return risen;
  float size = reach(point, blocker);
  float radius = texels_of(extent, size);
  // Below a texel the map knows no more than its own interpolation.
  if (radius < 1.0) return risen * mean_of_bilinear(point, 1);
  // The bias of a wide kernel would let light in where a wall meets the ground.
  point = locate(query, view, min(radius, 2.0));
  // A narrow facet's plane soon leads away from its body, through what shadows it: halfway to the
  // blockers it is left.
  point.nearest = 0.5 * (point.distance + blocker);
  float lit = 0.0;
  Taps taps = first_of_taps(rotation);
  for (int i = 0; i < parameter_taps; ++i, taps = next_of_taps(taps)) {
    vec2 tap = extent_tap(extent, taps, i, parameter_taps);
    if (risen < 1.0 && !is_risen(query, extent, tap)) continue;
    lit += compare_texel(point, texel_at(point, extent, tap, size));
  }
  return lit / float(parameter_taps);
}

// Found by the search: the blocker's depth in the map's range, black where there is none.
vec4 draw_diagnostic_blocker_depth(ShadowQuery query, vec2 picture) {
  int view = query.point < 0 ? -1 : choose_views(query.position).first;
  if (view < 0) return vec4(0.0, 0.0, 0.0, 1.0);
  MapPoint point = locate(query, view, 0.5);
  float blocker = find_blocker(point, extent_on_map(point), tap_rotation(query.pixel));
  return vec4(vec3(blocker < 0.0 ? 0.0 : max(depth_of_distance(point, blocker), 0.05)), 1.0);
}

// Width of the filter, white at an eighth of the map.
vec4 draw_diagnostic_penumbra_width(ShadowQuery query, vec2 picture) {
  int view = query.point < 0 ? -1 : choose_views(query.position).first;
  if (view < 0) return vec4(0.0, 0.0, 0.0, 1.0);
  MapPoint point = locate(query, view, 0.5);
  ExtentOnMap extent = extent_on_map(point);
  float blocker = find_blocker(point, extent, tap_rotation(query.pixel));
  float width = blocker < 0.0 ? 0.0 : 2.0 * texels_of(extent, reach(point, blocker));
  return vec4(vec3(8.0 * width / view_size(view)), 1.0);
}
