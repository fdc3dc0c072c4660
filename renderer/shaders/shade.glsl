// Fragment stage that draws one light where there is a surface. The program is this file followed by the
// technique's, which defines calculate_shadow. For lights of many points see shade_points.glsl.
#include "renderer/shaders/shadow_query.glsl"
#include "renderer/shaders/light_output.glsl"
#include "renderer/shaders/texel.glsl"

float calculate_shadow(ShadowQuery query);

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 position = texel_of(geometry_position, texel);
  Surface surface = unpack_surface(position, texel_of(geometry_words, texel));
  Illumination incoming = illuminate(light_center(), surface.position);
  bool judged = is_judged(surface, incoming);
  vec3 radiance = vec3(0.0);
  float visible = 0.0;
  // Nothing is asked of the technique where the light adds nothing anyway.
  if (judged) {
    visible = calculate_shadow(make_query(surface, incoming, gl_FragCoord.xy, 0));
    radiance = visible * reflect_light(light, incoming, surface);
  }
  write_light(surface, radiance, visible, judged);
}
