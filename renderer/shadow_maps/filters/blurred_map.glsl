// Reading a map that was filtered beforehand, or filtering texels of a buffer as they are read.
#ifndef PENUMBRA_BLURRED_MAP_GLSL
#define PENUMBRA_BLURRED_MAP_GLSL
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/filters/blur_weights.glsl"
#include "renderer/shadow_maps/diagnostics.glsl"
#include "renderer/shadow_maps/filters/footprint.glsl"

/// What the map keeps of a depth; the technique's encoder.
vec4 encode_depth(float depth);

/// Variance of the blur's weights along one side, texels: of a bell that is cut off, at most this.
const float blur_radius = float(parameter_blur);
const float blur_variance = parameter_blur_filter == blur_filter_box
                                ? blur_radius * (blur_radius + 1.0) / 3.0
                                : 0.25 * blur_radius * blur_radius;

/// Where and at which level a pixel reads the map.
struct MapProbes {
  int count;    // 1, or up to 16 where parameter anisotropic asks for them
  vec2 along;   // texels from end to end of the row of probes
  float level;  // of the mip chain
};

/// Level whose texels, with what the blur already covers, are as wide as what is read: none while the
/// blur alone is wider (Adorjan 2013, 3.3.3, whose level jumps where ours begins to rise). Widths add
/// as variances do; a square of w texels has w^2 / 12.
float level_after_blur(float width) {
  return 0.5 * log2(max(width * width - 12.0 * blur_variance, 1.0));
}

/// Probes along the longer side of a pixel's footprint are placed here, not by an anisotropic sampler:
/// lavapipe's takes one pixel's footprint for all four of a quad, which is garbage where they see
/// different surfaces.
MapProbes map_probes(ShadowQuery query, MapPoint point) {
#ifdef TEXELS_IN_BUFFER
  return MapProbes(1, vec2(0.0), 0.0);
#else
  vec4 footprint = map_footprint(query, point);
  bool right_is_longer = length(footprint.xy) >= length(footprint.zw);
  MapProbes probes;
  probes.along = right_is_longer ? footprint.xy : footprint.zw;
  float longer = max(length(probes.along), 1e-6);
  float shorter = right_is_longer ? length(footprint.zw) : length(footprint.xy);
  float count = parameter_anisotropic == 1 ? clamp(ceil(longer / max(shorter, 1.0)), 1.0, 16.0) : 1.0;
  probes.count = int(count);
  probes.level = parameter_mips == 1 ? level_after_blur(longer / count) : 0.0;
  return probes;
#endif
}

#ifdef TEXELS_IN_BUFFER
/// Where the four texels lie that are interpolated, the share of the later ones, and the sum of the blur's
/// weights along one side.
struct BlurTexels {
  ivec2 first;
  vec2 share;
  float total;
};
BlurTexels texels_around(MapPoint point) {
  vec2 corner = point.texel - 0.5;
  float total = 0.0;
  for (int i = -parameter_blur; i <= parameter_blur; ++i) total += blur_weight(i);
  return BlurTexels(ivec2(floor(corner)), fract(corner), total);
}

/// Weight of the texel at an offset from the first, -blur to blur + 1 along both sides.
float weight_in_blur(ivec2 offset, BlurTexels texels) {
  vec2 weight;
  for (int side = 0; side < 2; ++side) {
    float own = offset[side] <= parameter_blur ? blur_weight(offset[side]) : 0.0;
    float next = offset[side] > -parameter_blur ? blur_weight(offset[side] - 1) : 0.0;
    weight[side] = mix(own, next, texels.share[side]) / texels.total;
  }
  return weight.x * weight.y;
}

vec4 read_blurred(ShadowQuery query, MapPoint point) {
  BlurTexels texels = texels_around(point);
  precise vec4 sum = vec4(0.0);
  for (int y = -parameter_blur; y <= parameter_blur + 1; ++y)
    for (int x = -parameter_blur; x <= parameter_blur + 1; ++x) {
      sum += weight_in_blur(ivec2(x, y), texels) * encode_depth(fetch_depth(point, texels.first + ivec2(x, y)));
    }
  return sum;
}

/// Logarithm of the mean of what logarithms encode.
float read_logarithms(MapPoint point) {
  BlurTexels texels = texels_around(point);
  float greatest = encode_depth(fetch_depth(point, texels.first)).r;
  float sum = 0.0;
  for (int y = -parameter_blur; y <= parameter_blur + 1; ++y)
    for (int x = -parameter_blur; x <= parameter_blur + 1; ++x) {
      float weight = weight_in_blur(ivec2(x, y), texels);
      float value = encode_depth(fetch_depth(point, texels.first + ivec2(x, y))).r;
      // The greatest term is kept apart: exponentials of the others then lie between 0 and 1.
      float top = max(greatest, value);
      sum = sum * exp(greatest - top) + weight * exp(value - top);
      greatest = top;
    }
  return greatest + log(sum);
}

/// All tiles side by side, as the buffer holds them.
vec4 texel_in_picture(vec2 picture) {
  MapPoint point;
  point.view = square_at(picture, tiles_a_side);
  point.range = map_view(point.view).range;
  return encode_depth(fetch_depth(point, ivec2(picture * view_size(point.view))));
}
#else
uniform sampler2DArray blurred_map;

/// The first view, as the map keeps it.
vec4 texel_in_picture(vec2 picture) {
  return texelFetch(blurred_map, ivec3(ivec2(picture * map.texel.x), 0), 0);
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
  ivec2 size = textureSize(blurred_map, 0).xy;
  vec4 values, weights;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    values[i] = texel_nearest_to(blurred_map, ivec3(first + step, point.view), size).r;
    weights[i] = (step.x == 1 ? share.x : 1.0 - share.x) * (step.y == 1 ? share.y : 1.0 - share.y);
  }
  float greatest = max(max(values.x, values.y), max(values.z, values.w));
  return greatest + log(dot(weights, exp(values - greatest)));
}

#endif

/// How the depth of the receiver's own plane scatters along the axis within what the pixel reads.
struct PlaneScatter {
  float variance;  // m^2
  float third;     // central moment, m^2 times units near the scene's size: m^3 may leave floats
  float most;      // m^2: the variance of a bell that is no narrower, wherever texels are mixed
};

/// What a level's texels along one side, each the mean of a row of the map's, and the mixture of the two
/// nearest add to that: variance, third moment and most, in texels of the map.
vec3 scatter_of_level(float place, float level) {
  float size = exp2(level);
  float share = fract(place / size - 0.5);
  float within = (size * size - 1.0) / 12.0;
  float mixed = share * (1.0 - share) * size * size;
  return vec3(within + mixed, mixed * (1.0 - 2.0 * share) * size, within + 0.25 * size * size);
}

PlaneScatter scatter_of_plane(ShadowQuery query, MapPoint point) {
  PlaneScatter scatter = PlaneScatter(0.0, 0.0, 0.0);
  float bottom = point.plane_bottom.z;
  if (bottom >= 0.0) return scatter;
  // m for a step of a texel. A plane that light grazes is little lit, and not worth the shadows that so
  // great a grant would lose: 10 texels deep for each texel across at most, as with strategy slope.
  vec2 slope = (point.plane_top.xy - point.plane_bottom.xy * point.distance) / bottom;
  slope *= min(1.0, 10.0 * point.texel_width / max(length(slope), 1e-30));
  MapProbes probes = map_probes(query, point);
  float level = min(probes.level, log2(map.texel.x));
  float lower = floor(level);
  for (int side = 0; side < 2; ++side) {
    vec3 texels = mix(scatter_of_level(point.texel[side], lower),
                      scatter_of_level(point.texel[side], lower + 1.0), level - lower);
    float squared = slope[side] * slope[side];
    scatter.variance += squared * (blur_variance + texels.x);
    scatter.third += squared * (inverse_size() * slope[side]) * texels.y;
    scatter.most += squared * (blur_variance + texels.z);
  }
  // The row of probes of an anisotropic read.
  float count = float(probes.count);
  float along = dot(slope, probes.along);
  float row = along * along * (1.0 - 1.0 / (count * count)) / 12.0;
  scatter.variance += row;
  scatter.most += row;
  return scatter;
}

/// What the receiver is granted for it, m, with the strategies that know its plane.
float granted_to_plane(float grant, float needed) {
  return knows_plane() ? max(grant, map.texel.w * needed) : grant;
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
