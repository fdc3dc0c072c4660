// What the map says of each sample: lit, in shadow, or that its nearest texels disagree and the sample
// lies at the silhouette of a shadow (Chan and Durand 2004).
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/depth_map.glsl"
#include "techniques/hybrid/mask.glsl"

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;

layout(std430) buffer SampleCountBlock {
  uint counted_samples;     // that the light faces
  uint silhouette_samples;  // of these, at silhouettes
};

layout(location = 0) out float out_mask;

// Share of the nearest texels that leave the sample lit.
float filter_view(ShadowQuery query, int view) {
  MapPoint point = locate(query, view, float(parameter_reach));
  ivec2 corner = ivec2(floor(point.texel - 0.5)) - (parameter_reach - 1);
  int side = 2 * parameter_reach;
  float lit = 0.0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) lit += compare_texel(point, corner + ivec2(x, y));
  return lit / float(side * side);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 position = texel_of(geometry_position, texel);
  out_mask = mask_dark;
  if (position.w == 0.0) return;
  Surface surface = unpack_surface(position, texel_of(geometry_words, texel));
  Illumination incoming = illuminate(light_center(), surface.position);
  if (incoming.strength <= 0.0 || dot(surface.geometric_normal, incoming.to_light) <= 0.0) return;
#ifdef COUNT_SAMPLES
  atomicAdd(counted_samples, 1u);
#endif
  float lit = calculate_shadow(make_query(surface, incoming, gl_FragCoord.xy, 0));
  out_mask = lit == 0.0 ? mask_dark : lit == 1.0 ? mask_lit : mask_silhouette;
#ifdef COUNT_SAMPLES
  if (out_mask == mask_silhouette) atomicAdd(silhouette_samples, 1u);
#endif
}
