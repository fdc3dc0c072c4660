#include "renderer/shadow_maps/depth_map.glsl"

// Visibility of the light from query.position as one view of the map tells it: 1 lit, 0 occluded. The
// shared calculate_shadow asks once or twice per light and sample (per light point, for techniques that
// asked for several) where the surface faces the light. Techniques without a map define
// float calculate_shadow(ShadowQuery query) instead.
float filter_view(ShadowQuery query, int view) {
  MapPoint point = locate(query, view, 0.0);
  ivec2 texel = ivec2(floor(point.texel));
  float behind = (receiver_depth(point, texel) - fetch_depth(point, texel)) / point.range.z;  // m
  return 1.0 - clamp(behind / parameter_ramp, 0.0, 1.0);
}

// A picture named in description.diagnostics; query.point is -1 on background.
vec4 draw_diagnostic_depth(ShadowQuery query, vec2 picture) {
  int view = query.point < 0 ? -1 : choose_views(query.position).first;
  if (view < 0) return vec4(0.0, 0.0, 0.0, 1.0);
  MapPoint point = locate(query, view, 0.0);
  return vec4(vec3(receiver_depth(point, ivec2(floor(point.texel)))), 1.0);
}
