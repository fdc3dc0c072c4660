// What a technique computes: how much of the light reaches this point?
#ifndef PENUMBRA_SHADOW_QUERY_GLSL
#define PENUMBRA_SHADOW_QUERY_GLSL
#include "renderer/shaders/light_points.glsl"
#include "renderer/shaders/lighting.glsl"

struct ShadowQuery {
  vec3 position;         // receiver, world
  vec3 normal;           // geometric, unit, towards the viewer's side
  vec3 shading_normal;   // unit
  vec3 to_light;         // unit, to the light point in question
  float light_distance;  // m to that point; 1e30 when directional
  vec2 pixel;            // sample of the frame, as gl_FragCoord.xy
  int point;             // index within the batch, 0 .. points_per_batch - 1
};

// Whether the surface faces the light's centre and is inside its cone: where visibility means
// something.
bool is_judged(Surface surface, Illumination from_center) {
  return from_center.strength > 0.0 && dot(surface.geometric_normal, from_center.to_light) > 0.0 &&
         dot(surface.shading_normal, from_center.to_light) > 0.0;
}

ShadowQuery make_query(Surface surface, Illumination incoming, vec2 pixel, int point) {
  ShadowQuery query;
  query.position = surface.position;
  query.normal = surface.geometric_normal;
  query.shading_normal = surface.shading_normal;
  query.to_light = incoming.to_light;
  query.light_distance = incoming.distance;
  query.pixel = pixel;
  query.point = point;
  return query;
}
#endif
