// Draws the mean over a light's points where there is a surface.
#include "renderer/shaders/shadow_query.glsl"
#include "renderer/shaders/light_output.glsl"
#include "renderer/shaders/texel.glsl"

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;
uniform sampler2D light_sum;  // see shade_points.glsl

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 position = texel_of(geometry_position, texel);
  Surface surface = unpack_surface(position, texel_of(geometry_words, texel));
  Illumination from_center = illuminate(light_center(), surface.position);
  vec4 mean = texel_of(light_sum, texel);
  write_light(surface, mean.rgb, mean.a, is_judged(surface, from_center));
}
