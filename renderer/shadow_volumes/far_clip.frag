// Cuts volumes off at a far plane, as a projection with one does where depth is not clamped.
#include "renderer/shadow_volumes/deep_count.glsl"
#include "renderer/shadow_volumes/facing.glsl"

void main() {
  if (gl_FragCoord.z < volume.far_depth) discard;  // depth is reversed
  count_step();
}
