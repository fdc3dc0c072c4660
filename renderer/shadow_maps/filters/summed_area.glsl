// Means over rectangles of a depth map's first two moments, from a summed-area table: as many reads
// for wide rectangles as for narrow ones (Crow 1984; Adorjan 2013, 2.2.1).
#ifndef PENUMBRA_SUMMED_AREA_GLSL
#define PENUMBRA_SUMMED_AREA_GLSL
#include "renderer/shadow_maps/filters/summed_area_types.glsl"

layout(std430) readonly buffer SummedAreaBlock { TableSum summed_area[]; };

/// Sum over all texels of a view before `corner` along both sides.
TableSum sum_before(ivec2 corner, int view, int size) {
  if (any(lessThanEqual(corner, ivec2(0)))) return TableSum(0);
  return summed_area[(view * size + corner.y - 1) * size + corner.x - 1];
}

/// Sum over the texels from `low` up to, but not with, `high`. Whole numbers wrap, which differences
/// undo.
TableSum sum_of_rectangle(ivec2 low, ivec2 high, int view, int size) {
  return sum_before(high, view, size) - sum_before(ivec2(low.x, high.y), view, size) -
         sum_before(ivec2(high.x, low.y), view, size) + sum_before(low, view, size);
}

/// Mean moments over `width` x `width` texels around a place in texels, interpolated between the four
/// rectangles of whole texels that lie nearest: 16 reads. Texels beyond the border do not count.
vec2 mean_moments(vec2 place, int view, int size, int width) {
  vec2 corner = place - 0.5 * float(width);
  ivec2 first = ivec2(floor(corner));
  vec2 share = corner - vec2(first);
  vec2 sum = vec2(0.0);
  float area = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    float weight = (step.x == 1 ? share.x : 1.0 - share.x) * (step.y == 1 ? share.y : 1.0 - share.y);
    ivec2 low = clamp(first + step, ivec2(0), ivec2(size));
    ivec2 high = clamp(first + step + width, ivec2(0), ivec2(size));
    sum += weight * moments_of_sum(sum_of_rectangle(low, high, view, size), size);
    area += weight * float((high.x - low.x) * (high.y - low.y));
  }
  return sum / max(area, 1e-6);
}
#endif
