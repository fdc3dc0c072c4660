// What may stand before a region of the map, in nine reads.
#ifndef PENUMBRA_NEAREST_DEPTHS_GLSL
#define PENUMBRA_NEAREST_DEPTHS_GLSL
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/depth_map.glsl"
#include "renderer/shadow_maps/filters/nearest_depths_layout.glsl"

#ifdef TEXELS_IN_BUFFER
/// Tiles have no such chain: something may stand anywhere.
float nearest_depth(MapPoint point, float radius) { return 0.0; }
#else
uniform sampler2DArray nearest_depths;

/// No texel within `radius` texels of the receiver's place along either side is nearer to the light.
float nearest_depth(MapPoint point, float radius) {
  int base = textureSize(nearest_depths, 0).y;
  // Level k has texels as wide as 2^(k+1) of the map's; three of them, each at least as wide as the
  // radius, cover the region.
  int level = clamp(int(ceil(log2(max(radius, 1.0)))) - 1, 0, findMSB(base));
  ivec2 last = ivec2((base >> level) - 1);
  float width = exp2(float(level + 1));
  ivec2 first = ivec2(floor((point.texel - radius) / width));
  float nearest = 1.0;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      ivec2 texel = clamp(first + ivec2(x, y), ivec2(0), last) + level_offset(level, base);
      nearest = min(nearest, texel_of(nearest_depths, ivec3(texel, point.view)).r);
    }
  return nearest;
}
#endif
#endif
