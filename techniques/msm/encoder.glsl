// Four moments of a depth from -1 to 1, as they lie in a texel.
#ifndef PENUMBRA_MSM_ENCODER_GLSL
#define PENUMBRA_MSM_ENCODER_GLSL

// Odd and even moments are mixed in pairs so that all four fill 0 to 1 and rounding to 16 bits harms
// them alike (the transform of Peters and Klein 2015, 3.3). Their inverse below is exact.
vec4 texel_of_moments(vec4 m) {
  const float r = sqrt(3.0);
  if (parameter_precision != precision_unorm16) return m;
  return vec4(1.5 * m.x - 2.0 * m.z + 0.5, 4.0 * m.y - 4.0 * m.w,
              0.5 * r * m.x - 2.0 / 9.0 * r * m.z + 0.5, 0.5 * m.y + 0.5 * m.w);
}

vec4 moments_of_texel(vec4 t) {
  const float r = sqrt(3.0);
  if (parameter_precision != precision_unorm16) return t;
  t.xz -= 0.5;
  return vec4(-t.x / 3.0 + r * t.z, 0.125 * t.y + t.w, -0.75 * t.x + 0.75 * r * t.z, -0.125 * t.y + t.w);
}

vec4 encode_depth(float depth) {
  float z = 2.0 * depth - 1.0;
  return texel_of_moments(vec4(z, z * z, z * z * z, z * z * z * z));
}
#endif
