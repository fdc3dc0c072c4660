#include "renderer/shadow_maps/depth_map.glsl"
#include "renderer/shadow_maps/diagnostics.glsl"

// One comparison with the texel that the receiver falls into.
float calculate_shadow(ShadowQuery query) {
  MapPoint point = locate(query, 0.0);
  return point.face < 0 ? 1.0 : compare_texel(point, ivec2(floor(point.texel)));
}
