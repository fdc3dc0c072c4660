// Pictures that every map technique offers.
#ifndef PENUMBRA_MAP_DIAGNOSTICS_GLSL
#define PENUMBRA_MAP_DIAGNOSTICS_GLSL
#include "renderer/shadow_maps/depth_map.glsl"

// The first view as a grey picture: near is dark.
vec4 draw_diagnostic_map(ShadowQuery query, vec2 picture) {
  MapPoint point;
  point.face = 0;
  return vec4(vec3(fetch_depth(point, ivec2(picture * map.texel.x))), 1.0);
}
#endif
