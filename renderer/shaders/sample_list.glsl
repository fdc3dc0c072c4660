// Which sample of the frame a compute invocation works at: one of those with the same place in their
// pixels, all of them or those of a list. Workgroups have 64 invocations in a row.
#ifndef PENUMBRA_SAMPLE_LIST_GLSL
#define PENUMBRA_SAMPLE_LIST_GLSL
#include "renderer/shaders/frame.glsl"

layout(local_size_x = 64) in;

// As renderer/frame/sample_list.h has it. Nodes are for those who walk a hierarchy.
layout(push_constant) uniform WorkBlock {
  uint first, count;          // of the list
  uint set;                   // place within the pixel
  uint nodes;                 // of the hierarchy
  uint rounds;                // most of a walk in a dispatch
  uint slot;                  // of the first sample among those that keep something of their own
} work;

#ifdef WITH_SAMPLE_LIST
uniform usamplerBuffer listed_samples;  // x, and y in the upper half

// Of this invocation within the range.
uint listed_index() {
  return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
}

bool find_sample(out ivec2 texel) {
  uint index = listed_index();
  uint listed = texelFetch(listed_samples, int(work.first + min(index, work.count - 1u))).r;
  texel = ivec2(listed & 0xffffu, listed >> 16);
  return index < work.count;
}
#else
bool find_sample(out ivec2 texel) {
  // Blocks of 4x2 samples run in step and see nearly the same.
  uint lane = gl_LocalInvocationIndex;
  ivec2 place = ivec2(lane & 3u, lane >> 2 & 1u) + ivec2(lane >> 3 & 1u, lane >> 4) * ivec2(4, 2);
  int side = int(frame.size.z);
  ivec2 pixel = ivec2(gl_WorkGroupID.xy) * 8 + place;
  texel = pixel * side + ivec2(int(work.set) % side, int(work.set) / side);
  return all(lessThan(texel, ivec2(frame.size.xy)));
}
#endif
#endif
