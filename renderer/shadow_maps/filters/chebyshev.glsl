// Bounds of the light that a distribution of depths lets through.
#ifndef PENUMBRA_CHEBYSHEV_GLSL
#define PENUMBRA_CHEBYSHEV_GLSL

/// Most of a distribution that can lie at or behind `depth`: Chebyshev's one-sided inequality (van
/// Sambeek 2007, 2.2.6). `moments` are its mean and mean square; it deviates by `deviation` at least.
float upper_bound(vec2 moments, float depth, float deviation) {
  float variance = max(moments.y - moments.x * moments.x, deviation * deviation);
  float behind = depth - moments.x;
  if (behind <= 0.0) return 1.0;
  return variance / max(variance + behind * behind, 1.2e-38);
}

/// Light that bleeds is dim: what is below the reduction becomes shadow (Adorjan 2013, 3.3.1).
float reduce_bleeding(float lit) {
  return parameter_bleeding_reduction > 0.0 ? smoothstep(parameter_bleeding_reduction, 1.0, lit) : lit;
}
#endif
