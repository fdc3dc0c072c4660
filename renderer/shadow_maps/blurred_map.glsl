// Reading a map that was filtered beforehand.
#ifndef PENUMBRA_BLURRED_MAP_GLSL
#define PENUMBRA_BLURRED_MAP_GLSL
#include "renderer/shadow_maps/footprint.glsl"

uniform sampler2DArray blurred_map;

/// Mean of the map over the texels that the pixel covers.
vec4 read_blurred(ShadowQuery query, MapPoint point) {
  vec4 steps = map_footprint(query, point) / map.texel.x;
  return textureGrad(blurred_map, vec3(point.texel / map.texel.x, float(point.face)), steps.xy,
                     steps.zw);
}
#endif
