// Reading images of one level that are bound with Sampling::nearest. Where texelFetch would find the level anew
// for every lane (SAMPLES_TEXELS, see Device::finds_levels_by_lane) the sampler reads, with a third of the
// instructions.
#ifndef PENUMBRA_TEXEL_GLSL
#define PENUMBRA_TEXEL_GLSL
#ifdef SAMPLES_TEXELS
vec2 texel_middle(ivec2 texel, ivec2 size) { return (vec2(texel) + 0.5) * (1.0 / vec2(size)); }

vec4 texel_of(sampler2D image, ivec2 texel) {
  return textureLod(image, texel_middle(texel, textureSize(image, 0)), 0.0);
}
uvec4 texel_of(usampler2D image, ivec2 texel) {
  return textureLod(image, texel_middle(texel, textureSize(image, 0)), 0.0);
}
// Beyond the border the nearest one. `size` as textureSize tells it.
vec4 texel_nearest_to(sampler2DArray image, ivec3 texel, ivec2 size) {
  return textureLod(image, vec3(texel_middle(texel.xy, size), texel.z), 0.0);
}
vec4 texel_nearest_to(sampler2D image, ivec2 texel) { return texel_of(image, texel); }
vec4 texel_of(sampler2DArray image, ivec3 texel) {
  return texel_nearest_to(image, texel, textureSize(image, 0).xy);
}
#else
vec4 texel_of(sampler2D image, ivec2 texel) { return texelFetch(image, texel, 0); }
uvec4 texel_of(usampler2D image, ivec2 texel) { return texelFetch(image, texel, 0); }
vec4 texel_of(sampler2DArray image, ivec3 texel) { return texelFetch(image, texel, 0); }

ivec2 within(ivec2 texel, ivec2 size) { return clamp(texel, ivec2(0), size - 1); }
vec4 texel_nearest_to(sampler2DArray image, ivec3 texel, ivec2 size) {
  return texelFetch(image, ivec3(within(texel.xy, size), texel.z), 0);
}
vec4 texel_nearest_to(sampler2D image, ivec2 texel) {
  return texelFetch(image, within(texel, textureSize(image, 0)), 0);
}
#endif
#endif
