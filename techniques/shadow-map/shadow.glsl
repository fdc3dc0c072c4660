#include "renderer/shadow_maps/depth_map.glsl"
#include "renderer/shadow_maps/diagnostics.glsl"

// One comparison with the texel that the receiver falls into.
float filter_view(ShadowQuery query, int view) {
  MapPoint point = locate(query, view, 0.0);
  return compare_texel(point, ivec2(floor(point.texel)));
}
