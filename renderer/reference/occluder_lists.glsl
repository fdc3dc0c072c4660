// For each sample in a penumbra that has few of them: the triangles that may hide any of the light.
#ifndef PENUMBRA_OCCLUDER_LISTS_GLSL
#define PENUMBRA_OCCLUDER_LISTS_GLSL
#include "renderer/reference/receiver.glsl"

struct OccluderList {
  uint first;   // of its places
  uint count;
  uint hidden;  // batches that one triangle hides as a whole, one bit each
};

layout(std430) buffer ListBlock { uvec4 lists[]; };  // of each sample, in the order of OccluderList
// Triangle, and the batches of which it may hide some points, one bit each.
layout(std430) buffer OccluderBlock { uvec2 occluders[]; };

uint list_place() { return work.slot + listed_index(); }

OccluderList read_list() {
  uvec4 words = lists[list_place()];
  return OccluderList(words.x, words.y, words.z);
}

void write_list(OccluderList list) { lists[list_place()] = uvec4(list.first, list.count, list.hidden, 0u); }
#endif
