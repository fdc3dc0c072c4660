// One level of the chain of least depths: FROM_MAP the first, otherwise from the level before.
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/filters/nearest_depths_layout.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2DArray shadow_map;
layout(r32f) uniform image2DArray chain;
layout(push_constant) uniform LevelBlock { int level; int base; } step;

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(texel.xy, ivec2(step.base >> step.level)))) return;
  float nearest = 1.0;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 2; ++x) {
      ivec2 finer = 2 * texel.xy + ivec2(x, y);
#ifdef FROM_MAP
      if (all(lessThan(finer, textureSize(shadow_map, 0).xy)))
        nearest = min(nearest, texel_of(shadow_map, ivec3(finer, texel.z)).r);
#else
      nearest = min(nearest, imageLoad(chain, ivec3(finer + level_offset(step.level - 1, step.base), texel.z)).r);
#endif
    }
  }
  imageStore(chain, ivec3(texel.xy + level_offset(step.level, step.base), texel.z), vec4(nearest));
}
