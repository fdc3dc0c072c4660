// Fragment stage of a technique's own picture of its inner state. The program is this file followed
// by the technique's; the preamble names the function to call as DRAW_DIAGNOSTIC.
#include "renderer/shaders/shadow_query.glsl"
#include "renderer/shaders/texel.glsl"

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;

layout(location = 0) out vec4 out_color;

vec4 DRAW_DIAGNOSTIC(ShadowQuery query, vec2 picture);

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 position = texel_of(geometry_position, texel);
  Surface surface = unpack_surface(position, texel_of(geometry_words, texel));
  Illumination incoming = illuminate(light_center(), surface.position);
  int point = position.w == 0.0 ? -1 : 0;  // -1: background
  ShadowQuery query = make_query(surface, incoming, gl_FragCoord.xy, point);
  out_color = DRAW_DIAGNOSTIC(query, (gl_FragCoord.xy + frame.window.xy) / frame.window.zw);
}
