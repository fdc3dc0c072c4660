#include "renderer/shadow_maps/filters/blurred_map.glsl"
#include "renderer/shadow_maps/filters/chebyshev.glsl"
#include "renderer/shadow_maps/diagnostics.glsl"
#include "techniques/evsm/encoder.glsl"

// Bounds by the moments of exp(c z): far from the receiver's own depth the warp stretches distances.
// A deviation of depth is one of the warped depth by the warp's slope.
float positive_bound(vec2 moments, float depth, float deviation) {
  float warped = exp(parameter_c_positive * depth);
  return upper_bound(moments, warped, parameter_c_positive * warped * deviation);
}
float negative_bound(vec2 moments, float depth, float deviation) {
  float warped = -exp(parameter_c_negative * (0.5 - depth));
  return upper_bound(moments, warped, -parameter_c_negative * warped * deviation);
}

float filter_view(ShadowQuery query, int view) {
  MapPoint point = locate(query, view, float(parameter_blur));
  vec4 moments = read_blurred(query, point);
  if (!is_finite(moments)) return overflow();
  float depth = depth_of_distance(point, point.distance - point.grant);
  float deviation = parameter_minimum_deviation;
  float lit = positive_bound(moments.xy, depth, deviation);
  if (parameter_components == components_4) {
    // The mean of -exp(-c z) over a plane lies before its value at the middle (Jensen): by no more than
    // c / 2 variances of a bell around all of it, and not before its nearest point, sqrt(6) deviations
    // of a square.
    float variance = scatter_of_plane(query, point).most * point.range.z * point.range.z;
    float needed = min(0.5 * parameter_c_negative * variance, sqrt(6.0 * variance));
    float grant = granted_to_plane(point.grant, needed / point.range.z);
    lit = min(lit, negative_bound(moments.zw, depth_of_distance(point, point.distance - grant), deviation));
  }
  return reduce_bleeding(lit);
}

// First view: logarithms of both means as depths, positive red and negative green; magenta where a
// moment is no finite number.
vec4 draw_diagnostic_moments(ShadowQuery query, vec2 picture) {
  vec4 moments = texel_in_picture(picture);
  if (!is_finite(moments)) return vec4(1.0, 0.0, 1.0, 1.0);
  float negative = parameter_components == components_4
                       ? 0.5 - log(max(-moments.z, 1e-38)) / parameter_c_negative : 0.0;
  return vec4(log(moments.x) / parameter_c_positive, negative, 0.0, 1.0);
}
