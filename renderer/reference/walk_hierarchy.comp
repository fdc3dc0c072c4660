// Walks the hierarchy with the shaft to one batch of points and writes the sample's mask: where there is one
// batch only, and where too many triangles may hide part of the light.
#include "renderer/reference/point_tests.glsl"
#include "renderer/reference/walk.glsl"

#ifdef WITH_CANDIDATES
layout(r32ui) uniform uimage2DArray candidates;
#endif

// Triangles that a lane collects before it tests them: lanes that run in step wait less for one another
// than they would for each triangle.
const int most_collected = 8;

void main() {
  ivec2 texel;
  bool inside = find_sample(texel);
  read_points();
  Receiver receiver = read_receiver(texel);
  Shaft shaft = shaft_to_batch(receiver);
  uint mask = shaft_data.bits.x | hidden_by_receiver(receiver);
  mask = receiver.unlit ? all_hidden : mask;
  uint first = 0u, end = work.nodes;
  if (!inside) return;
#ifdef WITH_CANDIDATES
  first = imageLoad(candidates, ivec3(texel, 0)).r;
  end = imageLoad(candidates, ivec3(texel, 1)).r;
#endif
  uint node = begin_walk(texel, first);
#ifdef RESUMED
  mask |= occlusion_masks[mask_place(texel)];
#endif
  while (node < end && mask != all_hidden && rounds_left > 0) {
    --rounds_left;
    uint collected[most_collected];
    for (int i = 0; i < most_collected; ++i) collected[i] = 0u;
    int count = 0;
    while (node < end && count < most_collected && rounds_left > 0) {
      --rounds_left;
      int triangle = step_node(shaft, node);
      bool found = triangle >= 0;
      // Places of arrays that lanes choose are slow: all move on.
      for (int i = most_collected - 1; i > 0; --i) collected[i] = found ? collected[i - 1] : collected[i];
      collected[0] = found ? uint(triangle) : collected[0];
      count += found ? 1 : 0;
    }
    while (count > 0 && mask != all_hidden) {
      rounds_left -= rounds_of_test;
      mask |= hidden_by_triangle(planes_of(shaft, collected[0]), collected[0]);
      for (int i = 1; i < most_collected; ++i) collected[i - 1] = collected[i];
      --count;
    }
  }
  end_walk(texel, node, node >= end || mask == all_hidden);
  occlusion_masks[mask_place(texel)] = mask;
}
