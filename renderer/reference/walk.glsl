// Walks through the hierarchy that may take long. Some drivers end a shader's loops in silence after 65,535
// rounds, waiting lanes' included. Walks that might need as many are LONG: they stop before, and another
// dispatch, of a RESUMED program, goes on.
#ifndef PENUMBRA_WALK_GLSL
#define PENUMBRA_WALK_GLSL
#include "renderer/reference/receiver.glsl"
#include "renderer/shaders/faults.glsl"

#ifdef LONG_WALKS
layout(r32ui) uniform uimage2D walk_places;  // the node where a walk is to be resumed
#endif

uint begin_walk(ivec2 texel, uint first) {
#ifdef LONG_WALKS
  rounds_left = int(work.rounds);
#endif
#ifdef RESUMED
  first = imageLoad(walk_places, texel).r;
#endif
  return first;
}

void end_walk(ivec2 texel, uint node, bool done) {
#ifdef LONG_WALKS
  imageStore(walk_places, texel, uvec4(done ? 0xffffffffu : node));
#endif
  if (!done) atomicAdd(unfinished_invocations, 1u);
}
#endif
