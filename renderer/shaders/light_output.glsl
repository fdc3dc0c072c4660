// What a light's pass writes at a surface: the finished picture where it is the only light and pixels have one
// sample (FINISHES), otherwise what it adds to the radiance of others.
#ifndef PENUMBRA_LIGHT_OUTPUT_GLSL
#define PENUMBRA_LIGHT_OUTPUT_GLSL
#ifdef FINISHES
#include "renderer/shaders/pixel_output.glsl"
#include "renderer/shaders/unlit.glsl"
#else
layout(location = 0) out vec4 out_radiance;
#endif
#ifdef WITH_VISIBILITY
layout(location = VISIBILITY_LOCATION) out vec2 out_visibility;  // visibility times judged, judged
#endif

void write_light(Surface surface, vec3 radiance, float visibility, bool judged) {
#ifdef FINISHES
  write_pixel(unlit_surface(ivec2(gl_FragCoord.xy), surface.base_color) + radiance, frame.size.w);
#else
  out_radiance = vec4(radiance, 0.0);
#endif
#ifdef WITH_VISIBILITY
  out_visibility = judged ? vec2(visibility, 1.0) : vec2(0.0);
#endif
}
#endif
