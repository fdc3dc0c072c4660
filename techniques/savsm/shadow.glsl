#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/filters/chebyshev.glsl"
#include "renderer/shadow_maps/diagnostics.glsl"
#include "renderer/shadow_maps/filters/footprint.glsl"
#include "renderer/shadow_maps/filters/summed_area.glsl"

// Width of the filter, texels: the kernel, or what the pixel covers where that is wider.
int filter_width(ShadowQuery query, MapPoint point) {
  if (parameter_adaptive == 0) return parameter_kernel;
  float covered = ceil(footprint_width(map_footprint(query, point)));
  return clamp(int(min(covered, float(largest_width))), parameter_kernel, largest_width);
}

vec2 moments_at(ShadowQuery query, MapPoint point) {
  return mean_moments(point.texel, point.view, int(map.texel.x), filter_width(query, point));
}

float filter_view(ShadowQuery query, int view) {
  MapPoint point = locate(query, view, 0.5 * float(parameter_kernel));
  float depth = depth_of_distance(point, point.distance - point.grant);
  float deviation = parameter_minimum_deviation;
  return reduce_bleeding(upper_bound(moments_at(query, point), depth, deviation));
}

// First view: mean depth over one texel as the table has it, red; over the kernel green; what the map
// holds blue. All alike where the table is precise and the map flat.
vec4 draw_diagnostic_moments(ShadowQuery query, vec2 picture) {
  int size = int(map.texel.x);
  ivec2 texel = ivec2(picture * map.texel.x);
  vec2 center = vec2(texel) + 0.5;
  float stored = texel_of(shadow_map, ivec3(texel, 0)).r;
  return vec4(mean_moments(center, 0, size, 1).x, mean_moments(center, 0, size, parameter_kernel).x,
              stored, 1.0);
}

// By their logarithms, full at the widest: texels that a pixel covers red, width of the filter green.
vec4 draw_diagnostic_filter_width(ShadowQuery query, vec2 picture) {
  int view = query.point < 0 ? -1 : choose_views(query.position).first;
  if (view < 0) return vec4(0.0, 0.0, 0.0, 1.0);
  MapPoint point = locate(query, view, 0.0);
  vec2 widths = vec2(footprint_width(map_footprint(query, point)), float(filter_width(query, point)));
  return vec4(log2(widths + 1.0) / log2(float(largest_width) + 1.0), 0.0, 1.0);
}
