// Compute stage that sums the light of one batch of points. The program is this file followed by the
// technique's, which defines calculate_shadow.
#include "renderer/shaders/sample_list.glsl"
#include "renderer/shaders/shadow_query.glsl"

float calculate_shadow(ShadowQuery query);

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;
layout(rgba32f) uniform image2D light_sum;  // means so far: radiance where each point is shaded, visibility

void main() {
  ivec2 texel;
  if (!find_sample(texel)) return;
  vec4 position = texelFetch(geometry_position, texel, 0);
  if (position.w == 0.0) return;
  Surface surface = unpack_surface(position, texelFetch(geometry_words, texel, 0));
  vec2 pixel = vec2(texel) + 0.5;
  float seen = 0.0;
  vec2 shares = vec2(0.0);
#ifdef SHADE_EACH_POINT
  vec3 to_viewer = direction_to_viewer(surface.position);
#define ADD_SHARES shares += visibility * incoming.strength * reflected_shares(surface, to_viewer, incoming.to_light);
#else
#define ADD_SHARES
#endif
#define ADD_POINT(i)                                                                         \
  {                                                                                          \
    Illumination incoming = illuminate(light, light_points[i].xyz, surface.position);        \
    float visibility = calculate_shadow(make_query(surface, incoming, pixel, (i)));          \
    visibility = mix(0.0, visibility, float(i) < light.cone.z);                              \
    seen += visibility;                                                                      \
    ADD_SHARES                                                                               \
  }
  ALL_POINTS(ADD_POINT)
  vec4 sum = imageLoad(light_sum, texel);
  imageStore(light_sum, texel, sum + light.cone.w * vec4(colored(light, surface, shares), seen));
}
