// Pictures that every map technique offers.
#ifndef PENUMBRA_MAP_DIAGNOSTICS_GLSL
#define PENUMBRA_MAP_DIAGNOSTICS_GLSL
#include "renderer/shadow_maps/footprint.glsl"

// The first view as a grey picture: near is dark.
vec4 draw_diagnostic_map(ShadowQuery query, vec2 picture) {
  MapPoint point;
  point.view = 0;
  return vec4(vec3(fetch_depth(point, ivec2(picture * map.texel.x))), 1.0);
}

vec3 color_of_view(int view) {
  const vec3 colors[max_map_views] =
      vec3[](vec3(0.9, 0.2, 0.2), vec3(0.9, 0.85, 0.2), vec3(0.25, 0.75, 0.25), vec3(0.2, 0.8, 0.85),
             vec3(0.25, 0.35, 0.9), vec3(0.85, 0.3, 0.85), vec3(0.95, 0.55, 0.15), vec3(0.7));
  return colors[view];
}

// Views by colour, darker in shadow.
vec4 draw_diagnostic_views(ShadowQuery query, vec2 picture) {
  if (query.point < 0) return vec4(0.0, 0.0, 0.0, 1.0);
  ViewChoice choice = choose_views(query.position);
  if (choice.first < 0) return vec4(0.0, 0.0, 0.0, 1.0);
  vec3 color = color_of_view(choice.first);
  if (choice.share > 0.0) color = mix(color, color_of_view(choice.second), choice.share);
  return vec4((0.35 + 0.65 * calculate_shadow(query)) * color, 1.0);
}

// Texels that a pixel covers along its longer side, by their logarithm: red, yellow, green at one, cyan,
// blue.
vec4 draw_diagnostic_texels_per_pixel(ShadowQuery query, vec2 picture) {
  int view = query.point < 0 ? -1 : choose_views(query.position).first;
  if (view < 0) return vec4(0.0, 0.0, 0.0, 1.0);
  float width = footprint_width(map_footprint(query, locate(query, view, 0.0)));
  float fours = clamp(0.5 * log2(max(width, 1e-6)), -2.0, 2.0);
  return vec4(clamp(-fours, 0.0, 1.0), clamp(2.0 - abs(fours), 0.0, 1.0), clamp(fours, 0.0, 1.0), 1.0);
}
#endif
