#include "renderer/shadow_maps/depth_map.glsl"

uniform sampler2DArray shadow_map;

// One comparison with the texel that the receiver falls into.
float calculate_shadow(ShadowQuery query) {
  MapPoint point = locate(query);
  if (point.face < 0) return 1.0;
  ivec2 texel = min(ivec2(point.texel), ivec2(int(map.texel.x) - 1));
  float stored = texelFetch(shadow_map, ivec3(texel, point.face), 0).r;
  return receiver_depth(point, vec2(texel) + 0.5) <= stored ? 1.0 : 0.0;
}

// The first face as a grey picture: near is dark.
vec4 draw_diagnostic_map(ShadowQuery query, vec2 picture) {
  float stored = texelFetch(shadow_map, ivec3(ivec2(picture * map.texel.x), 0), 0).r;
  return vec4(vec3(stored), 1.0);
}
