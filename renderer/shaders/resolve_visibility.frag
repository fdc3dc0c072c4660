// Averages the visibility samples of a pixel: visibility where judged, and the share judged.
#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/texel.glsl"

uniform sampler2D visibility_samples;

layout(location = 0) out vec2 out_visibility;

void main() {
  int side = int(frame.size.z);
  ivec2 first = ivec2(gl_FragCoord.xy) * side;
  vec2 sum = vec2(0.0);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) sum += texel_of(visibility_samples, first + ivec2(x, y)).rg;
  out_visibility = vec2(sum.y > 0.0 ? sum.x / sum.y : 1.0, sum.y / float(side * side));
}
