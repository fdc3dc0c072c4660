// Averages the samples of a pixel in linear light and encodes once. Or encodes what was averaged before
// (FROM_LINEAR), the sky (SKY), surfaces that no light reaches (UNLIT), or those in the dark (BLACK).
#include "renderer/shaders/pixel_output.glsl"
#include "renderer/shaders/geometry_buffer.glsl"
#include "renderer/shaders/texel.glsl"
#include "renderer/shaders/unlit.glsl"

#ifdef FROM_LINEAR
uniform sampler2D linear_picture;

void main() { write_pixel(texel_of(linear_picture, ivec2(gl_FragCoord.xy)).rgb, 1.0); }
#elif defined(SKY)
void main() { write_pixel(sky(ivec2(gl_FragCoord.xy)), frame.size.w); }
#elif defined(BLACK)
void main() { write_pixel(vec3(0.0), 1.0); }
#else
uniform sampler2D geometry_position;
uniform usampler2D geometry_words;

vec3 unlit(ivec2 texel) { return unlit_surface(texel, unpack_color(texel_of(geometry_words, texel).z)); }

#ifdef UNLIT
void main() { write_pixel(unlit(ivec2(gl_FragCoord.xy)), frame.size.w); }
#else
uniform sampler2D radiance;

vec3 light_of_sample(ivec2 texel) {
  if (texel_of(geometry_position, texel).w == 0.0) return sky(texel);
  return unlit(texel) + texel_of(radiance, texel).rgb;
}

void main() {
#ifdef ONE_SAMPLE
  write_pixel(light_of_sample(ivec2(gl_FragCoord.xy)), frame.size.w);
#else
  int side = int(frame.size.z);
  ivec2 first = ivec2(gl_FragCoord.xy) * side;
  vec3 sum = vec3(0.0);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) sum += light_of_sample(first + ivec2(x, y));
  write_pixel(sum, frame.size.w / float(side * side));
#endif
}
#endif
#endif
