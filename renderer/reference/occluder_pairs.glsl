// Samples and triangles that are to be tested against all points of a batch, behind the arguments of the
// dispatch that does it.
#ifndef PENUMBRA_OCCLUDER_PAIRS_GLSL
#define PENUMBRA_OCCLUDER_PAIRS_GLSL
layout(std430) buffer PairBlock {
  uint groups_x, groups_y, groups_z;  // of 64
  uint pair_count;
  uvec2 pairs[];  // x and, in the upper half, y of the sample; triangle
};
#endif
