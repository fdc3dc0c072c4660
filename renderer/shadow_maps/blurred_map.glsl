// Reading a map that was filtered beforehand.
#ifndef PENUMBRA_BLURRED_MAP_GLSL
#define PENUMBRA_BLURRED_MAP_GLSL
#include "renderer/shadow_maps/footprint.glsl"

uniform sampler2DArray blurred_map;

/// Mean of the map over the texels that the pixel covers. Probes along the longer side are placed here,
/// not by an anisotropic sampler: lavapipe's takes one pixel's footprint for all four of a quad, which
/// is garbage where they see different surfaces.
vec4 read_blurred(ShadowQuery query, MapPoint point) {
  vec4 footprint = map_footprint(query, point);
  bool right_is_longer = length(footprint.xy) >= length(footprint.zw);
  vec2 along = right_is_longer ? footprint.xy : footprint.zw;
  float longer = max(length(along), 1e-6);
  float shorter = right_is_longer ? length(footprint.zw) : length(footprint.xy);
  float probes = parameter_anisotropic == 1 ? clamp(ceil(longer / max(shorter, 1.0)), 1.0, 16.0) : 1.0;
  float level = parameter_mips == 1 ? log2(max(longer / probes, 1.0)) : 0.0;
  vec4 sum = vec4(0.0);
  for (int i = 0; i < int(probes); ++i) {
    vec2 place = point.texel + along * ((float(i) + 0.5) / probes - 0.5);
    sum += textureLod(blurred_map, vec3(place / map.texel.x, float(point.face)), level);
  }
  return sum / probes;
}
#endif
