// Begins the masks of samples that have lists of occluders: what their facets hide, and batches that one
// triangle hides as a whole. What is left to be tested is listed: thus all lanes of the tests have work.
#include "renderer/reference/occluder_lists.glsl"
#include "renderer/reference/occluder_pairs.glsl"
#include "renderer/reference/point_tests.glsl"

uniform usamplerBuffer list_texels, occluder_texels;  // to be read: the lists

void main() {
  ivec2 texel;
  bool inside = find_sample(texel);
  read_points();
  uint mask = shaft_data.bits.x | hidden_by_receiver(read_receiver(texel));
  uint bit = shaft_data.bits.y;
  if (!inside) return;
  uvec4 words = texelFetch(list_texels, int(list_place()));
  OccluderList list = OccluderList(words.x, words.y, words.z);
  mask = (list.hidden >> bit & 1u) != 0u ? all_hidden : mask;
  occlusion_masks[mask_place(texel)] = mask;
  uint end = list.first + (mask == all_hidden ? 0u : list.count);
  uint count = 0u;
  for (uint i = list.first; i < end; ++i) count += texelFetch(occluder_texels, int(i)).y >> bit & 1u;
  if (count == 0u) return;
  uint place = atomicAdd(pair_count, count);
  // Where a group begins: at each 64th pair.
  uint groups = (place + count + 63u) / 64u - (place + 63u) / 64u;
  if (groups > 0u) atomicAdd(groups_x, groups);
  for (uint i = list.first; i < end; ++i) {
    uvec2 occluder = texelFetch(occluder_texels, int(i)).xy;
    if ((occluder.y >> bit & 1u) == 0u) continue;
    pairs[place] = uvec2(uint(texel.x) | uint(texel.y) << 16, occluder.x);
    ++place;
  }
}
