// Compute stage that sums the light of one batch of points. The program is this file followed by the
// technique's, which defines calculate_shadow.
#include "renderer/shaders/sample_list.glsl"
#include "renderer/shaders/shadow_query.glsl"
#include "renderer/shaders/texel.glsl"

float calculate_shadow(ShadowQuery query);

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;
layout(rgba32f) uniform image2D light_sum;  // means so far: radiance, visibility
#ifdef WITH_UNCERTAINTY
layout(rgba32f) uniform image2DArray scramble_sums;  // by pixel: mean brightness that each set saw
#endif

void main() {
  ivec2 texel;
  if (!find_sample(texel)) return;
  vec4 position = texel_of(geometry_position, texel);
  if (position.w == 0.0) return;
  Surface surface = unpack_surface(position, texel_of(geometry_words, texel));
  vec2 pixel = vec2(texel) + 0.5;
  float seen = 0.0;
#ifdef SHADE_EACH_POINT
  vec2 shares = vec2(0.0);
  vec3 to_viewer = direction_to_viewer(surface.position);
  vec2 brightness = vec2(luminance(colored(light, surface, vec2(1.0, 0.0))),
                         luminance(colored(light, surface, vec2(0.0, 1.0))));
#define LIGHT_OF_POINT visibility * incoming.strength * reflected_shares(surface, to_viewer, incoming.to_light)
#define ADD_LIGHT(k, share) shares += share; ADD_BRIGHTNESS(k, dot(brightness, share))
#else
  vec3 unshadowed = reflect_light(light, illuminate(light_center(), surface.position), surface);
  float brightness = luminance(unshadowed);
#define LIGHT_OF_POINT vec2(visibility)
#define ADD_LIGHT(k, share) ADD_BRIGHTNESS(k, brightness * share.x)
#endif
#ifdef WITH_UNCERTAINTY
  float scrambled[scramble_count];
  for (int k = 0; k < scramble_count; ++k) scrambled[k] = 0.0;
#define ADD_BRIGHTNESS(k, value) scrambled[k] += value;
#else
#define ADD_BRIGHTNESS(k, value)
#endif
#define ADD_POINT(i)                                                                         \
  {                                                                                          \
    Illumination incoming = illuminate(light_points[i].xyz, surface.position);               \
    float visibility = calculate_shadow(make_query(surface, incoming, pixel, (i)));          \
    visibility = mix(0.0, visibility, float(i) < light.cone.z);                              \
    seen += visibility;                                                                      \
    vec2 share = LIGHT_OF_POINT;                                                             \
    ADD_LIGHT((i) % scramble_count, share)                                                   \
  }
  ALL_POINTS(ADD_POINT)
#ifdef SHADE_EACH_POINT
  vec3 radiance = colored(light, surface, shares);
#else
  vec3 radiance = seen * unshadowed;
#endif
  vec4 sum = imageLoad(light_sum, texel);
  imageStore(light_sum, texel, sum + light.cone.w * vec4(radiance, seen));
#ifdef WITH_UNCERTAINTY
  int side = int(frame.size.z);
  float weight = light.cone.w * float(scramble_count) / float(side * side);
  for (int k = 0; k < scramble_count; k += 4) {
    ivec3 place = ivec3(texel / side, k / 4);
    vec4 four = vec4(scrambled[k], scrambled[k + 1], scrambled[k + 2], scrambled[k + 3]);
    imageStore(scramble_sums, place, imageLoad(scramble_sums, place) + weight * four);
  }
#endif
}
