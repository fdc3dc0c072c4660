// Fragment stage that adds one light, or one batch of its points, to the frame. The program is this
// file followed by the technique's, which defines calculate_shadow.
#include "renderer/shaders/shadow_query.glsl"

float calculate_shadow(ShadowQuery query);

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;

layout(location = 0) out vec4 out_radiance;
#ifdef WITH_VISIBILITY
layout(location = 1) out vec2 out_visibility;  // visibility times judged, judged
#endif

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(geometry_position, texel, 0);
  if (position.w == 0.0) discard;
  Surface surface = unpack_surface(position, texelFetch(geometry_words, texel, 0));

  int first = sample_of_pixel(gl_FragCoord.xy) * points_per_batch;
  vec3 center = int(light.position.w) == light_kind_directional ? -light.direction.xyz : light.position.xyz;
  ShadowQuery query;
  query.position = surface.position;
  query.normal = surface.geometric_normal;
  query.shading_normal = surface.shading_normal;
  query.pixel = gl_FragCoord.xy;

  Illumination from_center = illuminate(light, center, surface.position);
  bool judged = from_center.strength > 0.0 && dot(surface.geometric_normal, from_center.to_light) > 0.0 &&
                dot(surface.shading_normal, from_center.to_light) > 0.0;
  vec3 radiance = vec3(0.0);
  float visible = 0.0;
#ifdef MANY_POINTS
  vec3 unshadowed = reflect_light(light, from_center, surface);
  int count = int(light.cone.z);
  for (int i = 0; i < count; ++i) {
    Illumination incoming = illuminate(light, light_points[first + i].xyz, surface.position);
    query.to_light = incoming.to_light;
    query.light_distance = incoming.distance;
    query.point = i;
    float visibility = calculate_shadow(query);
    visible += visibility;
#ifdef SHADE_EACH_POINT
    if (visibility > 0.0) radiance += visibility * reflect_light(light, incoming, surface);
#else
    radiance += visibility * unshadowed;
#endif
  }
  radiance /= float(count);
  visible /= float(count);
#else
  // Nothing is asked of the technique where the light adds nothing anyway.
  if (judged) {
    query.to_light = from_center.to_light;
    query.light_distance = from_center.distance;
    query.point = 0;
    visible = calculate_shadow(query);
    radiance = visible * reflect_light(light, from_center, surface);
  }
#endif
  out_radiance = vec4(radiance * light.cone.w, 0.0);
#ifdef WITH_VISIBILITY
  out_visibility = judged ? vec2(visible, 1.0) * light.cone.w : vec2(0.0);
#endif
}
