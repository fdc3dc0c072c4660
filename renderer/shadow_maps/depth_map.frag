// Depth computed anew for every fragment where interpolated depth would be wrong inside triangles; otherwise
// (INTERPOLATED_DEPTH) for holes alone.
#include "renderer/shaders/caster.glsl"
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/bias/strategies.glsl"
#include "renderer/shadow_maps/texels/depth_coding.glsl"

#ifdef TILE
layout(std140) uniform TileBlock { uvec4 tile; };  // x its index
layout(std430) buffer MapTexelBlock { uint map_texels[]; };
MapView view = map.views[tile.x];
#else
layout(std140) uniform MapViewBlock { MapView view; };
#endif

#ifndef INTERPOLATED_DEPTH
layout(location = 0) in float axis_distance;  // m along the view's axis
layout(location = 4) flat in vec4 range;      // the view's
layout(location = 5) flat in float slope_scale;
#endif

#ifdef SECOND_LAYER
uniform sampler2D first_depths;
// Positions are floats: this much is lost on the way to a depth.
float rounding_of_depth() { return exp2(-21.0) * range.y * range.z; }
#endif

void main() {
  cut_holes();
#ifndef INTERPOLATED_DEPTH
  float distance = axis_distance;
#ifdef LAYER
  // One of two layers; layered_depths.frag makes a map of both.
  gl_FragDepth = clamp(even_depth_of(range, distance), 0.0, 1.0);
#ifdef SECOND_LAYER
  float first = texel_of(first_depths, ivec2(gl_FragCoord.xy)).r;
  // Facets that meet in an edge lie at one depth, but for rounding.
  if (gl_FragDepth <= first + 4.0 * rounding_of_depth()) discard;
#endif
#else
  float texel = texel_size(view, distance) * widest_texel(spread_at(view, gl_FragCoord.xy));
  float bias = range.w;
  if (moves_facet(gl_FrontFacing)) {
    // What this facet spans over the kernel; a facet seen edge-on is not followed to infinity.
    float span = max(abs(dFdx(distance)), abs(dFdy(distance)));
    bias += slope_scale * (1.0 + 2.0 * map.texel.y) * min(span, 10.0 * texel);
  }
  bias += slope_scale * rounding_grant(range, distance);
  float depth = clamp(even_depth_of(range, distance + bias), 0.0, 1.0);
  float kept = kept_depth(range, depth);
#ifdef TILE
#ifdef variant_depth_bits_16
  kept = round(65535.0 * kept) / 65535.0;
#endif
  // Lesser depths have greater bits of 1 - z, and the cleared buffer is far (Alecu 2014, listing 3.1).
  uvec2 place = uvec2(gl_FragCoord.xy);
  uint side = uint(view.texels.x);
  if (all(lessThan(place, uvec2(side))))
    atomicMax(map_texels[uint(view.texels.y) + place.y * side + place.x], floatBitsToUint(1.0 - kept));
#else
  gl_FragDepth = kept;
#endif
#endif
#endif
}
