#include "renderer/shadow_maps/filters/blurred_map.glsl"
#include "renderer/shadow_maps/filters/chebyshev.glsl"
#include "renderer/shadow_maps/diagnostics.glsl"
#include "techniques/vsm/encoder.glsl"

float filter_view(ShadowQuery query, int view) {
  MapPoint point = locate(query, view, float(parameter_blur));
  float depth = depth_of_distance(point, point.distance - point.grant);
  float deviation = parameter_minimum_deviation;
  return reduce_bleeding(upper_bound(read_blurred(query, point).rg, depth, deviation));
}

// First view: mean depth red, deviation from it green, ten times enlarged.
vec4 draw_diagnostic_moments(ShadowQuery query, vec2 picture) {
  vec2 moments = texel_in_picture(picture).rg;
  return vec4(moments.x, 10.0 * sqrt(max(moments.y - moments.x * moments.x, 0.0)), 0.0, 1.0);
}
