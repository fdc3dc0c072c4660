// Pictures that every map technique offers.
#ifndef PENUMBRA_MAP_DIAGNOSTICS_GLSL
#define PENUMBRA_MAP_DIAGNOSTICS_GLSL
#include "renderer/shadow_maps/filters/footprint.glsl"

// Which square of a square picture a place lies in, and where in it.
int square_at(inout vec2 picture, int squares_a_side) {
  vec2 place = picture * float(squares_a_side);
  ivec2 square = clamp(ivec2(floor(place)), ivec2(0), ivec2(squares_a_side - 1));
  picture = place - vec2(square);
  return square.y * squares_a_side + square.x;
}

// The first view as a grey picture, or all tiles: near is dark.
vec4 draw_diagnostic_map(ShadowQuery query, vec2 picture) {
  MapPoint point;
#ifdef TEXELS_IN_BUFFER
  // All tiles side by side: each in its own range.
  point.view = square_at(picture, tiles_a_side);
#else
  point.view = 0;
#endif
  point.range = map_view(point.view).range;
  return vec4(vec3(fetch_depth(point, ivec2(picture * view_size(point.view)))), 1.0);
}

vec3 color_of_view(int view) {
  const vec3 colors[max_map_views] =
      vec3[](vec3(0.9, 0.2, 0.2), vec3(0.9, 0.85, 0.2), vec3(0.25, 0.75, 0.25), vec3(0.2, 0.8, 0.85),
             vec3(0.25, 0.35, 0.9), vec3(0.85, 0.3, 0.85), vec3(0.95, 0.55, 0.15), vec3(0.7),
             vec3(0.55, 0.15, 0.1), vec3(0.55, 0.5, 0.1), vec3(0.1, 0.45, 0.2), vec3(0.1, 0.4, 0.5),
             vec3(0.3, 0.15, 0.6), vec3(0.95, 0.6, 0.7), vec3(0.6, 0.9, 0.55), vec3(0.55, 0.65, 0.95));
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

// Blue at 16 texels along a side by way of cyan, green and yellow to red at 1024.
vec3 color_of_size(float size) {
  float share = clamp((log2(size) - 4.0) / 6.0, 0.0, 1.0);
  return clamp(vec3(4.0 * share - 2.0, 2.0 - abs(4.0 * share - 2.0), 2.0 - 4.0 * share), 0.0, 1.0);
}

// All views side by side: a frame coloured by how many texels each has, around a grey that tells how much
// it matters against the one that matters most, where the layout knows.
vec4 draw_diagnostic_tiles(ShadowQuery query, vec2 picture) {
  int view = square_at(picture, int(ceil(sqrt(float(view_count())))));
  if (view >= view_count()) return vec4(0.0, 0.0, 0.0, 1.0);
  vec2 away = abs(picture - 0.5);
  float edge = max(away.x, away.y);
  if (edge > 0.49) return vec4(0.0, 0.0, 0.0, 1.0);
  if (edge > 0.35) return vec4(color_of_size(view_size(view)), 1.0);
#ifdef TEXELS_IN_BUFFER
  return vec4(vec3(sqrt(map_view(view).choice.y)), 1.0);
#else
  return vec4(vec3(1.0), 1.0);
#endif
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
