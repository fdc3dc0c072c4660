// What may stand before a region of the map, in nine reads.
#ifndef PENUMBRA_NEAREST_DEPTHS_GLSL
#define PENUMBRA_NEAREST_DEPTHS_GLSL
#include "renderer/shadow_maps/depth_map.glsl"

uniform sampler2DArray nearest_depths;

/// No texel within `radius` texels of the receiver's place along either side is nearer to the light.
float nearest_depth(MapPoint point, float radius) {
  // Level k has texels as wide as 2^(k+1) of the map's; three of them, each at least as wide as the
  // radius, cover the region.
  int level = clamp(int(ceil(log2(max(radius, 1.0)))) - 1, 0, textureQueryLevels(nearest_depths) - 1);
  ivec2 last = textureSize(nearest_depths, level).xy - 1;
  float width = exp2(float(level + 1));
  ivec2 low = clamp(ivec2(floor((point.texel - radius) / width)), ivec2(0), last);
  ivec2 high = clamp(ivec2(floor((point.texel + radius) / width)), ivec2(0), last);
  float nearest = 1.0;
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x)
      nearest = min(nearest, texelFetch(nearest_depths, ivec3(x, y, point.face), level).r);
  return nearest;
}
#endif
