#include "renderer/shadow_maps/blurred_map.glsl"
#include "renderer/shadow_maps/diagnostics.glsl"

// Most of the light that can reach `depth`: Chebyshev's one-sided inequality (van Sambeek 2007, 2.2.6).
float upper_bound(vec2 moments, float depth) {
  float deviation = parameter_minimum_deviation * map.range.z;
  float variance = max(moments.y - moments.x * moments.x, deviation * deviation);
  float behind = depth - moments.x;
  if (behind <= 0.0) return 1.0;
  return variance / max(variance + behind * behind, 1e-30);
}

float calculate_shadow(ShadowQuery query) {
  MapPoint point = locate(query, float(parameter_blur));
  if (point.face < 0) return 1.0;
  float lit = upper_bound(read_blurred(query, point).rg, depth_of_distance(point.distance - point.grant));
  // Light that bleeds is dim: what is below the reduction becomes shadow (Adorjan 2013, 3.3.1).
  return parameter_bleeding_reduction > 0.0 ? smoothstep(parameter_bleeding_reduction, 1.0, lit) : lit;
}

// First face: mean depth red, deviation from it green, ten times enlarged.
vec4 draw_diagnostic_moments(ShadowQuery query, vec2 picture) {
  vec2 moments = textureLod(blurred_map, vec3(picture, 0.0), 0.0).rg;
  return vec4(moments.x, 10.0 * sqrt(max(moments.y - moments.x * moments.x, 0.0)), 0.0, 1.0);
}
