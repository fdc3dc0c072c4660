// Sky where no surface was drawn: horizon to zenith by elevation.
#include "renderer/shaders/frame.glsl"

layout(location = 0) out vec4 out_position;
layout(location = 1) out uvec4 out_words;
layout(location = 2) out vec4 out_radiance;

void main() {
  vec2 ndc = 2.0 * gl_FragCoord.xy / frame.size.xy - 1.0;
  // Of clip space, z 0 and w 1 are the ray's direction, whatever the near plane.
  vec3 direction = frame.camera_position.w > 0.5
                       ? normalize((frame.world_from_clip * vec4(ndc, 0.0, 1.0)).xyz)
                       : frame.camera_direction.xyz;
  float elevation = clamp(direction.y, 0.0, 1.0);
  out_position = vec4(0.0);
  out_words = uvec4(0u);
  out_radiance = vec4(mix(frame.background_low.rgb, frame.background_high.rgb, sqrt(elevation)), 0.0);
}
