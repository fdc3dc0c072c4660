#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/filters/blurred_map.glsl"
#include "renderer/shadow_maps/diagnostics.glsl"
#include "renderer/shadow_maps/filters/percentage_closer.glsl"
#include "techniques/esm/encoder.glsl"

// Logarithm of the mean of exp(c z) over what the pixel covers; infinite after an overflow.
float filtered_logarithm(ShadowQuery query, MapPoint point) {
  if (parameter_filtering == filtering_logarithmic) return read_logarithms(point);
  float mean = read_blurred(query, point).r;
  if (!is_finite(vec4(mean))) return overflow();
  // No exponential is below 1; a sampler's rounding between 1e38 and 1 may leave less, or nothing.
  return log(max(mean, 1.0));
}

#ifdef variant_fallback_z_max
// Greatest depth in the blur's kernel around the four texels that are interpolated.
#ifdef TEXELS_IN_BUFFER
float farthest_depth(MapPoint point) {
  ivec2 first = ivec2(floor(point.texel - 0.5));
  float farthest = 0.0;
  for (int y = -parameter_blur; y <= parameter_blur + 1; ++y)
    for (int x = -parameter_blur; x <= parameter_blur + 1; ++x)
      farthest = max(farthest, fetch_depth(point, first + ivec2(x, y)));
  return farthest;
}
#else
uniform sampler2DArray farthest_map;

float farthest_depth(MapPoint point) {
  ivec2 first = ivec2(floor(point.texel - 0.5));
  ivec2 size = textureSize(farthest_map, 0).xy;
  float farthest = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 texel = first + ivec2(i & 1, i >> 1);
    farthest = max(farthest, texel_nearest_to(farthest_map, ivec3(texel, point.view), size).r);
  }
  return farthest;
}
#endif
#endif

// exp(c (z - d)) replaces a comparison only where nothing in the kernel lies behind the receiver
// (Adorjan 2013, 2.2.2). Judged without any bias: the map's own is taken back.
bool assumption_fails(MapPoint point, float stored) {
  if (parameter_fallback == fallback_none) return false;
  float logarithm = parameter_c * depth_of_distance(point, point.distance + point.range.w);
#ifdef variant_fallback_z_max
  stored = parameter_c * farthest_depth(point);
#endif
  return stored - logarithm > log(1.0 + parameter_threshold);
}

float filter_view(ShadowQuery query, int view) {
  MapPoint point = locate(query, view, float(parameter_blur));
  float stored = filtered_logarithm(query, point);
  if (!is_finite(vec4(stored))) return overflow();
  if (assumption_fails(point, stored)) return mean_of_box(locate(query, view, 0.5), 2);
  // Over a slope the mean of exponentials is greater than that of the middle: no further bias is needed.
  return min(exp(stored - parameter_c * depth_of_distance(point, point.distance)), 1.0);
}

// First view: the logarithm of what is stored, over c; magenta where it is no finite number.
vec4 draw_diagnostic_moments(ShadowQuery query, vec2 picture) {
  float stored = texel_in_picture(picture).r;
  if (!is_finite(vec4(stored))) return vec4(1.0, 0.0, 1.0, 1.0);
  if (parameter_filtering == filtering_linear) stored = log(stored);
  return vec4(vec3(stored / parameter_c), 1.0);
}

// Where percentage-closer filtering takes over: red over the grey of what is seen.
vec4 draw_diagnostic_fallback(ShadowQuery query, vec2 picture) {
  int view = query.point < 0 ? -1 : choose_views(query.position).first;
  if (view < 0) return vec4(0.0, 0.0, 0.0, 1.0);
  MapPoint point = locate(query, view, float(parameter_blur));
  float lit = calculate_shadow(query);
  if (!is_finite(vec4(lit))) return vec4(1.0, 0.0, 1.0, 1.0);
  bool fails = assumption_fails(point, filtered_logarithm(query, point));
  return vec4(fails ? vec3(1.0, 0.3 * lit, 0.3 * lit) : vec3(0.1 + 0.6 * lit), 1.0);
}
