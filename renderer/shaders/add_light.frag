// Adds the mean over a light's points to the frame where there is a surface.
#include "renderer/shaders/shadow_query.glsl"

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;
uniform sampler2D light_sum;  // see shade_points.glsl

layout(location = 0) out vec4 out_radiance;
#ifdef WITH_VISIBILITY
layout(location = 1) out vec2 out_visibility;  // visibility times judged, judged
#endif

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(geometry_position, texel, 0);
  Surface surface = unpack_surface(position, texelFetch(geometry_words, texel, 0));
  Illumination from_center = illuminate(light_center(), surface.position);
  vec4 mean = texelFetch(light_sum, texel, 0);
  out_radiance = vec4(mean.rgb, 0.0);
#ifdef WITH_VISIBILITY
  out_visibility = is_judged(surface, from_center) ? vec2(mean.a, 1.0) : vec2(0.0);
#endif
}
