// What each bias strategy knows and grants. The map itself is moved by the constant bias and, with slope,
// by the slope of its casters; with strategies that know two surfaces, towards the second.
#ifndef PENUMBRA_BIAS_STRATEGIES_GLSL
#define PENUMBRA_BIAS_STRATEGIES_GLSL

/// Texels are compared with the receiver's plane, which is as precise as the surface is flat.
bool knows_plane() {
  return parameter_bias_strategy == bias_strategy_receiver_plane ||
         parameter_bias_strategy == bias_strategy_auto;
}

/// Every comparison is with the receiver's plane. Maps of back faces need it where a body is thinner than
/// its slope over a texel.
bool compares_with_plane() {
  return knows_plane() || parameter_bias_strategy == bias_strategy_back_faces;
}

/// The receiver is moved along its normal.
bool moves_along_normal() { return parameter_bias_strategy == bias_strategy_normal_offset; }

/// A caster's facet is moved by what it spans over the kernel. The front faces of double-sided materials
/// stand in maps of back faces too.
bool moves_facet(bool front_facing) {
  return parameter_bias_strategy == bias_strategy_slope ||
         (parameter_bias_strategy == bias_strategy_back_faces && front_facing);
}

/// What the receiver is granted in every comparison, in widths of a texel.
float granted_texels(float kernel_radius) {
  // What a facet at 45 degrees spans over the kernel.
  if (parameter_bias_strategy == bias_strategy_constant) return 0.5 + kernel_radius;
  // The receiver's plane is known, but bent surfaces leave it. Half a texel and a quarter of the radius
  // make as many pixels too dark as too bright on the survey's scenes.
  if (moves_along_normal() || knows_plane()) return 0.5 + 0.25 * kernel_radius;
  return 0.0;
}

/// How far a map of two surfaces may lie behind the first, in widths of a texel. auto: as much again as
/// receivers are granted. dual-depth: what a facet spans over the kernel that rises four units for each
/// across.
float texels_behind_first(float kernel_radius) {
  return parameter_bias_strategy == bias_strategy_auto ? granted_texels(kernel_radius)
                                                       : 4.0 * (0.5 + kernel_radius);
}

/// Depth of the map that is made of two surfaces, never more than `most` behind the first for strategies
/// that bound it.
float between_surfaces(float first, float second, float most) {
  if (parameter_bias_strategy == bias_strategy_second_depth) return second;
  float middle = 0.5 * (first + second);
  if (parameter_bias_strategy == bias_strategy_midpoint) return middle;
  return min(middle, first + most);
}
#endif
