// The map to compare with, from the two surfaces that are nearest to the light.
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/bias/strategies.glsl"
#include "renderer/shadow_maps/texels/depth_coding.glsl"

uniform sampler2DArray first_depths;
uniform sampler2DArray second_depths;  // 1 where there is no second surface

layout(push_constant) uniform LayerBlock { uint view; } layer;

// How far the map may lie behind the first surface, m.
float greatest_offset(MapView view, float first) {
  float distance = view.range.x + first / view.range.z;
  float texel = texel_size(view, distance) * widest_texel(spread_at(view, gl_FragCoord.xy));
  return map.texel.w * texels_behind_first(map.texel.y) * texel;
}

void main() {
  MapView view = map.views[layer.view];
  ivec3 texel = ivec3(gl_FragCoord.xy, layer.view);
  float first = texel_of(first_depths, texel).r;
  float second = texel_of(second_depths, texel).r;
  float depth = between_surfaces(first, second, greatest_offset(view, first) * view.range.z);
  float bias =
      view.range.w + map.texel.w * rounding_grant(view.range, view.range.x + depth / view.range.z);
  gl_FragDepth = kept_depth(view.range, clamp(depth + bias * view.range.z, 0.0, 1.0));
}
