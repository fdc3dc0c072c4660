// How sums of moments are kept in a summed-area table, by the variant parameter `table`.
#ifndef PENUMBRA_SUMMED_AREA_TYPES_GLSL
#define PENUMBRA_SUMMED_AREA_TYPES_GLSL

// `size` is the map's width and height, texels.

/// Widest rectangle whose sum must be had, texels.
const int largest_width = parameter_adaptive == 1 ? parameter_kernel_maximum : parameter_kernel;

#if defined(variant_table_fp32)
#define TableSum vec2
TableSum table_value(vec2 moments, int size) { return moments; }
vec2 moments_of_sum(TableSum sum, int size) { return sum; }

#elif defined(variant_table_distributed)
// The first eight bits of a moment and the rest in sums of their own (Adorjan 2013, 3.3.5).
#define TableSum vec4
const float distribution = 256.0;
TableSum table_value(vec2 moments, int size) {
  vec2 whole = floor(distribution * moments);
  return vec4(whole / distribution, distribution * moments - whole);
}
vec2 moments_of_sum(TableSum sum, int size) { return sum.xy + sum.zw / distribution; }

#elif defined(variant_table_int32)
// Fixed point with as many bits as leave room for the widest rectangle: the table itself may wrap.
#define TableSum uvec2
const float units = min(4294967040.0 / float((largest_width + 1) * (largest_width + 1)), 16777216.0);
TableSum table_value(vec2 moments, int size) { return uvec2(units * moments + 0.5); }
vec2 moments_of_sum(TableSum sum, int size) { return vec2(sum) / units; }

#elif defined(variant_table_int32_plain)
// Fixed point of which the sum over the whole map still fits: 32 bits less those of its texels
// (Adorjan 2013, 3.3.5), 12 at 1024x1024.
#define TableSum uvec2
float units_of(int size) { return floor(4294967040.0 / (float(size) * float(size))); }
TableSum table_value(vec2 moments, int size) { return uvec2(units_of(size) * moments + 0.5); }
vec2 moments_of_sum(TableSum sum, int size) { return vec2(sum) / units_of(size); }

#elif defined(variant_table_fp64)
#define TableSum dvec2
TableSum table_value(vec2 moments, int size) { return dvec2(moments); }
vec2 moments_of_sum(TableSum sum, int size) { return vec2(sum); }
#endif
#endif
