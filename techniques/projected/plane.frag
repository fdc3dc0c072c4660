// Keeps the part of a thrown triangle that falls on its receiver: samples of the frame whose surface
// lies in the plane, inside the polygon, under a caster between plane and light.
#include "renderer/shaders/caster.glsl"
#include "renderer/shaders/geometry_buffer.glsl"
#include "renderer/shaders/texel.glsl"
#include "techniques/projected/receiver.glsl"

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;

layout(location = 0) in float height;

layout(location = 0) out float out_covered;

void main() {
  cut_holes();
  // Casters beyond the light would throw mirrored shadows, those below the plane inverted ones, and
  // those in the plane are the receiver itself.
  if (height <= receiver.heights.x || height >= receiver.heights.y) discard;
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 surface = texel_of(geometry_position, texel);
  if (surface.w == 0.0) discard;
  if (abs(dot(receiver.plane.xyz, surface.xyz) - receiver.plane.w) > receiver.heights.z) discard;
  vec3 normal = geometric_normal_of(surface, texel_of(geometry_words, texel));
  if (dot(normal, receiver.plane.xyz) < 0.99) discard;
  for (int i = 0; i < int(receiver.heights.w); ++i)
    if (dot(sides[i].xyz, surface.xyz) < sides[i].w) discard;
  out_covered = 1.0;
}
