// The question a technique answers: how much of the light reaches this point?
#ifndef PENUMBRA_SHADOW_QUERY_GLSL
#define PENUMBRA_SHADOW_QUERY_GLSL
#include "renderer/shaders/lighting.glsl"

layout(std140) uniform LightBlock { LightData light; };
// Points of this batch: positions, or unit directions to a directional light.
// Sample s of a pixel uses [s * points_per_batch, (s + 1) * points_per_batch).
layout(std140) uniform LightPointBlock { vec4 light_points[points_per_batch * max_supersampling]; };

struct ShadowQuery {
  vec3 position;         // receiver, world
  vec3 normal;           // geometric, unit, towards the viewer's side
  vec3 shading_normal;   // unit
  vec3 to_light;         // unit, to the light point in question
  float light_distance;  // m to that point; 1e30 when directional
  vec2 pixel;            // sample of the frame, as gl_FragCoord.xy
  int point;             // index within the batch, 0 .. points_per_batch - 1
};

// Index of this sample within its pixel, 0 .. samples per pixel - 1.
int sample_of_pixel(vec2 pixel) {
  int side = int(frame.size.z);
  ivec2 p = ivec2(pixel) % side;
  return p.y * side + p.x;
}
#endif
