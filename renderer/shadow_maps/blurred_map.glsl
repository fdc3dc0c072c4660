// Reading a map that was filtered beforehand.
#ifndef PENUMBRA_BLURRED_MAP_GLSL
#define PENUMBRA_BLURRED_MAP_GLSL
#include "renderer/shadow_maps/footprint.glsl"

uniform sampler2DArray blurred_map;

/// Where and at which level a pixel reads the map.
struct MapProbes {
  int count;    // 1, or up to 16 where parameter anisotropic asks for them
  vec2 along;   // texels from end to end of the row of probes
  float level;  // of the mip chain
};

/// Probes along the longer side of a pixel's footprint are placed here, not by an anisotropic sampler:
/// lavapipe's takes one pixel's footprint for all four of a quad, which is garbage where they see
/// different surfaces.
MapProbes map_probes(ShadowQuery query, MapPoint point) {
  vec4 footprint = map_footprint(query, point);
  bool right_is_longer = length(footprint.xy) >= length(footprint.zw);
  MapProbes probes;
  probes.along = right_is_longer ? footprint.xy : footprint.zw;
  float longer = max(length(probes.along), 1e-6);
  float shorter = right_is_longer ? length(footprint.zw) : length(footprint.xy);
  float count = parameter_anisotropic == 1 ? clamp(ceil(longer / max(shorter, 1.0)), 1.0, 16.0) : 1.0;
  probes.count = int(count);
  probes.level = parameter_mips == 1 ? log2(max(longer / count, 1.0)) : 0.0;
  return probes;
}

/// Mean of the map over the texels that the pixel covers.
vec4 read_blurred(ShadowQuery query, MapPoint point) {
  MapProbes probes = map_probes(query, point);
  float share = 1.0 / float(probes.count);
  precise vec4 sum = vec4(0.0);  // of small shares: values may be near the format's end
  for (int i = 0; i < probes.count; ++i) {
    vec2 place = point.texel + probes.along * ((float(i) + 0.5) * share - 0.5);
    sum += share * textureLod(blurred_map, vec3(place / map.texel.x, float(point.view)), probes.level);
  }
  return sum;
}

/// Logarithm of the mean of what a map of logarithms encodes, interpolated between four texels; no
/// sampler does that.
float read_logarithms(MapPoint point) {
  vec2 corner = point.texel - 0.5;
  ivec2 first = ivec2(floor(corner));
  vec2 share = corner - vec2(first);
  ivec2 last = textureSize(blurred_map, 0).xy - 1;
  vec4 values, weights;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    values[i] = texelFetch(blurred_map, ivec3(clamp(first + step, ivec2(0), last), point.view), 0).r;
    weights[i] = (step.x == 1 ? share.x : 1.0 - share.x) * (step.y == 1 ? share.y : 1.0 - share.y);
  }
  float greatest = max(max(values.x, values.y), max(values.z, values.w));
  return greatest + log(dot(weights, exp(values - greatest)));
}

/// Overflow is passed on as infinity, so that it shows: a clamp or comparison would hide it.
bool is_finite(vec4 value) { return !any(isnan(value)) && !any(isinf(value)); }
float overflow() { return uintBitsToFloat(0x7f800000u); }

// Level 0 red, 1 yellow, 2 green, 3 and above blue; black outside the map.
vec4 draw_diagnostic_mip_level(ShadowQuery query, vec2 picture) {
  int view = query.point < 0 ? -1 : choose_views(query.position).first;
  if (view < 0) return vec4(0.0, 0.0, 0.0, 1.0);
  MapPoint point = locate(query, view, 0.0);
  float level = min(map_probes(query, point).level, 3.0);
  return vec4(clamp(2.0 - level, 0.0, 1.0), clamp(min(level, 3.0 - level), 0.0, 1.0),
              clamp(level - 2.0, 0.0, 1.0), 1.0);
}
#endif
