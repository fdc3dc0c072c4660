// What a sample shows without any light: surfaces by ambient and emitted light, and the sky.
#ifndef PENUMBRA_UNLIT_GLSL
#define PENUMBRA_UNLIT_GLSL
#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/texel.glsl"

#ifdef EMISSIVE
uniform sampler2D geometry_emitted;
#endif

vec3 unlit_surface(ivec2 texel, vec3 base_color) {
  vec3 radiance = frame.ambient.rgb * base_color;
#ifdef EMISSIVE
  radiance += texel_of(geometry_emitted, texel).rgb;
#endif
  return radiance;
}

// Horizon to zenith by elevation.
vec3 sky(ivec2 texel) {
  vec2 ndc = 2.0 * (vec2(texel) + 0.5) / frame.size.xy - 1.0;
  // Of clip space, z 0 and w 1 are the ray's direction, whatever the near plane.
  vec3 direction = frame.camera_position.w > 0.5
                       ? normalize((frame.world_from_clip * vec4(ndc, 0.0, 1.0)).xyz)
                       : frame.camera_direction.xyz;
  float elevation = clamp(direction.y, 0.0, 1.0);
  return mix(frame.background_low.rgb, frame.background_high.rgb, sqrt(elevation));
}
#endif
