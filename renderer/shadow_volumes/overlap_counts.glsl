// How many volumes hide each of 32 points of the light, more than hide its centre: four counts of -32 to
// 31 in a float, whose 24 bits hold them exactly, so that blending can add them up.
#ifndef PENUMBRA_OVERLAP_COUNTS_GLSL
#define PENUMBRA_OVERLAP_COUNTS_GLSL

const int coverage_point_count = 32;
const int counts_per_float = 4;
const float counts_per_place = 64.0;

// Takes the lowest count off.
float next_count(inout float packed) {
  float count = mod(packed + 0.5 * counts_per_place, counts_per_place) - 0.5 * counts_per_place;
  packed = (packed - count) / counts_per_place;
  return count;
}
#endif
