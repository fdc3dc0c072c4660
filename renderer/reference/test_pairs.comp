// Tests triangles against all points of a batch, each as seen from a sample.
#include "renderer/reference/occluder_pairs.glsl"
#include "renderer/reference/point_tests.glsl"

uniform usamplerBuffer pair_texels;  // the block, to be read

void main() {
  read_points();
  uint index = gl_GlobalInvocationID.x;
  uint count = pair_count;
  uvec2 pair = texelFetch(pair_texels, int(2u + min(index, count - 1u))).xy;
  ivec2 texel = ivec2(pair.x & 0xffffu, pair.x >> 16);
  Shaft shaft = shaft_to_batch(read_receiver(texel));
  uint hidden = hidden_by_triangle(planes_of(shaft, pair.y), pair.y);
  if (index < count && hidden != 0u) atomicOr(occlusion_masks[mask_place(texel)], hidden);
}
