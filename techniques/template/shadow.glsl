#include "renderer/shadow_maps/depth_map.glsl"

// Visibility of the light from query.position: 1 lit, 0 occluded. Called once per light and sample
// (per light point, for techniques that asked for several) where the surface faces the light.
float calculate_shadow(ShadowQuery query) {
  MapPoint point = locate(query, 0.0);
  if (point.face < 0) return 1.0;
  ivec2 texel = ivec2(floor(point.texel));
  float behind = (receiver_depth(point, texel) - fetch_depth(point, texel)) / map.range.z;  // m
  return 1.0 - clamp(behind / parameter_ramp, 0.0, 1.0);
}

// A picture named in description.diagnostics; query.point is -1 on background.
vec4 draw_diagnostic_depth(ShadowQuery query, vec2 picture) {
  MapPoint point = locate(query, 0.0);
  float depth = point.face < 0 || query.point < 0 ? 0.0 : receiver_depth(point, ivec2(floor(point.texel)));
  return vec4(vec3(depth), 1.0);
}
