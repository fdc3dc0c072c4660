#include "renderer/shadow_maps/filters/blurred_map.glsl"
#include "renderer/shadow_maps/diagnostics.glsl"
#include "techniques/msm/encoder.glsl"

// Moments of any depths whatever are mixed in by this share, so that rounding cannot leave what a
// distribution may have: the Hankel matrix stays positive definite.
vec4 valid_moments(vec4 m) {
  return mix(m, vec4(0.0, 0.375, 0.0, 0.375), parameter_moment_bias);
}

// Weight of the first of three depths of a distribution with these moments.
float weight_of(float a, float b, float c, vec4 m) {
  return (b * c - m.x * (b + c) + m.y) / ((a - b) * (a - c));
}

// Least share that any distribution with four given moments has before depth z: one whose support is
// z and the two roots of a quadratic attains it (the Hamburger problem; Peters and Klein 2015, 3.1).
float least_share_before(vec4 m, float z) {
  // Solve [1 m1 m2; m1 m2 m3; m2 m3 m4] q = (1, z, z^2) by factors L D L^T.
  float l21 = m.x;
  float l31 = m.y;
  float d2 = m.y - m.x * m.x;
  float l32_d2 = m.z - m.x * m.y;
  float l32 = l32_d2 / d2;
  float d3 = m.w - m.y * m.y - l32 * l32_d2;
  float y2 = z - l21;
  float y3 = z * z - l31 - l32 * y2;
  float q3 = y3 / d3;
  float q2 = y2 / d2 - l32 * q3;
  float q1 = 1.0 - l21 * q2 - l31 * q3;
  // Roots of q1 + q2 x + q3 x^2.
  float p = 0.5 * q2 / q3;
  float root = sqrt(max(p * p - q1 / q3, 0.0));
  float low = -p - root;
  float high = -p + root;
  if (z <= low) return 0.0;
  if (z <= high) return weight_of(low, z, high, m);
  return 1.0 - weight_of(z, low, high, m);
}

// How far before the middle of a plane, m, four moments allow none of it: at the nearer of the two
// depths that have its first three moments, the roots of x^2 - third / variance x - variance. A stretch
// that is seen from its middle may hide 5/18 before it.
float before_plane(PlaneScatter scatter) {
  if (scatter.variance <= 0.0) return 0.0;
  float half_sum = 0.5 * scatter.third / scatter.variance / inverse_size();
  return sqrt(half_sum * half_sum + scatter.variance) - half_sum;
}

float filter_view(ShadowQuery query, int view) {
  MapPoint point = locate(query, view, float(parameter_blur));
  vec4 moments = valid_moments(moments_of_texel(read_blurred(query, point)));
  float grant = granted_to_plane(point.grant, before_plane(scatter_of_plane(query, point)));
  float depth = 2.0 * depth_of_distance(point, point.distance - grant) - 1.0;
  float lit = clamp(1.0 - least_share_before(moments, depth), 0.0, 1.0);
  // The bias of moments leaves a little shadow on what is lit.
  const float nearly_lit = 0.98;
  float reduction = parameter_bleeding_reduction;
  return clamp((lit - reduction) / max(nearly_lit - reduction, 1e-3), 0.0, 1.0);
}

// First view: mean depth red, deviation from it green, ten times enlarged.
vec4 draw_diagnostic_moments(ShadowQuery query, vec2 picture) {
  vec4 moments = moments_of_texel(texel_in_picture(picture));
  float deviation = 0.5 * sqrt(max(moments.y - moments.x * moments.x, 0.0));
  return vec4(0.5 * moments.x + 0.5, 10.0 * deviation, 0.0, 1.0);
}
