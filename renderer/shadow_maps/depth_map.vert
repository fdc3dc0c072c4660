#include "renderer/shaders/caster.glsl"
#include "renderer/shadow_maps/texels/depth_coding.glsl"

#ifdef TILE
layout(std140) uniform TileBlock { uvec4 tile; };  // x its index
out float gl_ClipDistance[4];
#else
layout(std140) uniform MapViewBlock { MapView view; };
#endif

layout(location = 0) in vec3 position;
#ifndef INTERPOLATED_DEPTH
layout(location = 0) out float axis_distance;
layout(location = 4) flat out vec4 range;
layout(location = 5) flat out float slope_scale;
#endif

void main() {
  pass_holes();
#ifdef TILE
  // In the corner of an area as large as the largest tile. Its sides alone clip: there is no near or far.
  MapView view = map.views[tile.x];
  vec2 clip = (view.clip_from_world * vec4(position, 1.0)).xy;
  gl_Position = vec4((clip + 1.0) * view.texels.x / float(largest_tile) - 1.0, 0.0, 1.0);
  // One that shows nothing is left out.
  vec4 inside = vec4(1.0 + clip, 1.0 - clip);
  inside = mix(vec4(-1.0), inside, bvec4(view.choice.x > 0.0));
  for (int side = 0; side < 4; ++side) gl_ClipDistance[side] = inside[side];
#else
  gl_Position = view.clip_from_world * vec4(position, 1.0);
#endif
  float distance = dot(position - view.origin.xyz, view.forward.xyz);
#ifdef INTERPOLATED_DEPTH
  gl_Position.z = clip_depth(view.range, distance + view.range.w, gl_Position.w, map.texel.w);
#else
  axis_distance = distance;
  range = view.range;
  slope_scale = map.texel.w;
#endif
}
