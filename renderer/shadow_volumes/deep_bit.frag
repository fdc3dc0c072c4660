// Passes the samples whose count has one bit set, so that the stencil's write mask can store it. Counts
// that the stencil cannot hold are kept at its ends, so that only zero reads as zero.
#include "renderer/shaders/texel.glsl"

uniform sampler2D deep_counts;

layout(push_constant) uniform DeepBitBlock {
  uint bit;
  uint most;  // of the bits that hold the count
} wanted;

void main() {
  int count = int(texel_of(deep_counts, ivec2(gl_FragCoord.xy)).r);
  int kept = clamp(count, -int(wanted.most >> 1), int(wanted.most));
  if ((uint(kept) & wanted.bit) == 0u) discard;
}
