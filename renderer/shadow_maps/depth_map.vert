#include "renderer/shaders/caster.glsl"
#ifdef INTERPOLATED_DEPTH
#include "renderer/shadow_maps/texels/depth_coding.glsl"
#endif

#ifdef TILE
layout(std140) uniform MapBlock { MapData map; };
layout(std140) uniform TileBlock { uvec4 tile; };  // x its index
out float gl_ClipDistance[4];
#else
layout(std140) uniform MapViewBlock { MapView view; };
#endif

layout(location = 0) in vec3 position;
#ifdef MASKED
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;
layout(location = 1) out vec2 surface_uv;
layout(location = 2) out float vertex_alpha;
#endif
layout(location = 0) out vec3 world_position;

void main() {
  world_position = position;
#ifdef MASKED
  surface_uv = uv;
  vertex_alpha = color.a;
#endif
#ifdef TILE
  // In the corner of an area as large as the largest tile. Its sides alone clip: there is no near or far.
  MapView view = map.views[tile.x];
  vec2 clip = (view.clip_from_world * vec4(position, 1.0)).xy;
  gl_Position = vec4((clip + 1.0) * view.texels.x / float(largest_tile) - 1.0, 0.0, 1.0);
  // One that shows nothing is left out.
  vec4 inside = vec4(1.0 + clip, 1.0 - clip);
  for (int side = 0; side < 4; ++side) gl_ClipDistance[side] = view.choice.x > 0.0 ? inside[side] : -1.0;
#else
  gl_Position = view.clip_from_world * vec4(position, 1.0);
#ifdef INTERPOLATED_DEPTH
  float distance = dot(position - view.origin.xyz, view.forward.xyz) + view.range.w;
  gl_Position.z = clip_depth(view.range, distance, gl_Position.w, map.texel.w);
#endif
#endif
}
