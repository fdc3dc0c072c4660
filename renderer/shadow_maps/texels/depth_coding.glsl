// What a map keeps of a depth that runs evenly from 0 at near to 1 at far. Parameters `depth` and
// `depth_bits` choose; techniques without them keep it as it is, in 32 bits. `range` is a view's.
#ifndef PENUMBRA_DEPTH_CODING_GLSL
#define PENUMBRA_DEPTH_CODING_GLSL
#include "renderer/shaders/map.glsl"

/// Distance along a view's axis as an even depth.
float even_depth_of(vec4 range, float distance) { return (distance - range.x) * range.z; }

/// Distance from the light of what is at this one along a view's axis, m.
float from_light(MapView view, float distance) { return view.right.w + distance; }

/// World size of a texel of an unwarped view at this distance along its axis, m.
float texel_size(MapView view, float distance) {
  return view.forward.w * mix(1.0, from_light(view, distance), view.origin.w > 0.5);
}

/// How a view spreads its texels around a place. A step d, in texels, is a step of texels * d /
/// (1 + dot(lean, d)) on the unwarped map.
struct Spread {
  mat2 texels;
  vec2 lean;
};

#ifdef UNWARPED
Spread spread_at(MapView view, vec2 texel) { return Spread(mat2(1.0), vec2(0.0)); }
#else
Spread spread_at(MapView view, vec2 texel) {
  mat3 unwarp = mat3(view.unwarp[0].xyz, view.unwarp[1].xyz, view.unwarp[2].xyz);
  vec3 place = unwarp * vec3(texel, 1.0);
  vec2 plain = place.xy / place.z;
  Spread spread;
  spread.lean = vec2(unwarp[0].z, unwarp[1].z) / place.z;
  spread.texels = mat2(unwarp[0].xy / place.z - plain * spread.lean.x,
                       unwarp[1].xy / place.z - plain * spread.lean.y);
  return spread;
}
#endif

/// Longest step on the unwarped map for a step of one texel: the greater singular value.
float widest_texel(Spread spread) {
  mat2 m = spread.texels;
  return 0.5 * (length(vec2(m[0][0] + m[1][1], m[0][1] - m[1][0])) +
                length(vec2(m[0][0] - m[1][1], m[0][1] + m[1][0])));
}

#ifdef variant_depth_hyperbolic
// As a projection leaves it after the division by w: even in 1/z. Parallel rays have no such division;
// the views of a light are all of one kind.
bool is_divided() { return map_view(0).origin.w > 0.5; }

float coded_depth(vec4 range, float depth) {
  float within = clamp(depth, 0.0, 1.0);
  return mix(depth, within * range.y / (range.x + within / range.z), is_divided());
}

float even_depth(vec4 range, float coded) {
  return mix(coded, coded * range.x / (range.y - coded / range.z), is_divided());
}

/// Change of distance for a change of what is kept, m, at this distance along the axis.
float coding_slope(vec4 range, float distance) {
  return mix(1.0 / range.z, distance * distance / (range.x * range.y * range.z), is_divided());
}
#else
float coded_depth(vec4 range, float depth) { return depth; }
float even_depth(vec4 range, float coded) { return coded; }
float coding_slope(vec4 range, float distance) { return 1.0 / range.z; }
#endif

/// How far a kept depth may lie from the one that was meant, in what is kept: half a step of 16 bits, two
/// units in the last place of a float below 1. Even depth in 32 bits loses less than positions do, which
/// are floats too.
float coded_rounding() {
#if defined(variant_depth_bits_16)
  return 0.5 / 65535.0;
#elif defined(variant_depth_hyperbolic)
  return exp2(-23.0);
#else
  return 0.0;
#endif
}

/// The same as a distance, m.
float coding_error(vec4 range, float distance) { return coded_rounding() * coding_slope(range, distance); }

/// What is added to every depth that is kept, as glPolygonOffset does (Sindholt 2005, 2.2.8), in place
/// of what its rounding needs. 0 for techniques that do more than compare depths.
float granted_units() {
#if defined(variant_depth_bits_16)
  return parameter_bias_units / 65535.0;
#elif defined(variant_depth_bits_32)
  return parameter_bias_units * exp2(-24.0);
#else
  return 0.0;
#endif
}

/// What an even depth is kept as.
float kept_depth(vec4 range, float depth) { return min(coded_depth(range, depth) + granted_units(), 1.0); }

/// What a strategy grants for the rounding of what is kept, m.
float rounding_grant(vec4 range, float distance) {
  return granted_units() > 0.0 ? 0.0 : coding_error(range, distance);
}

/// Place on the depth axis of the clip volume, for views whose kept depths a projection interpolates: those of
/// parallel rays, and hyperbolic ones. `distance` along the axis, m, with its bias; `w` of the clip volume.
/// `slope_scale` of the rounding is granted as for each fragment elsewhere.
float clip_depth(vec4 range, float distance, float w, float slope_scale) {
  float depth = even_depth_of(range, distance) * w;
#ifdef variant_depth_hyperbolic
  // Even in 1/z. Behind the light, where nothing is drawn, no division by what may be 0.
  float divisor = distance > 0.5 * range.x ? distance : w;
  depth *= mix(1.0, range.y / divisor, is_divided());
#endif
  float granted = granted_units() > 0.0 ? granted_units() : slope_scale * coded_rounding();
  return depth + granted * w;
}
#endif
