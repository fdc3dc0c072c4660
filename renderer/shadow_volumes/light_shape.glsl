// The light's extent as a point sees it: a disc, a ball or a square around the origin of a plane.
#ifndef PENUMBRA_LIGHT_SHAPE_GLSL
#define PENUMBRA_LIGHT_SHAPE_GLSL
#include "renderer/shadow_volumes/light_side.glsl"

const int extent_sphere = 1;
const int extent_rectangle = 3;

// Half sizes along right and up: m, or tangents of the angle for a directional light.
vec2 light_half_size() {
  return int(light.extent.x) == extent_rectangle ? light.extent.yz : light.extent.yy;
}

// Radius of the sphere around the whole light, likewise.
float light_radius() {
  vec2 half_size = light_half_size();
  return int(light.extent.x) == extent_rectangle ? length(half_size) : half_size.x;
}

// Perspective of a point onto the plane of the light, scaled so that the extent becomes the unit disc
// or the square from -1 to 1.
struct LightPlane {
  vec3 right, up;   // unit
  vec3 towards;     // unit, from the point to the plane
  float distance;   // m; 1 for directional lights, whose plane is at no place
  vec2 center;      // of the extent, before scaling
  vec2 scale;
};

LightPlane light_plane(vec3 position) {
  LightPlane plane;
  plane.right = light.right.xyz;
  plane.up = light.up.xyz;
  vec2 half_size = light_half_size();
  if (is_directional()) {
    plane.towards = -light.direction.xyz;
    plane.distance = 1.0;
    plane.center = vec2(0.0);
    plane.scale = 1.0 / half_size;
    return plane;
  }
  vec3 to_center = light.position.xyz - position;
  if (int(light.extent.x) == extent_sphere) {
    // Seen from anywhere a ball is a disc that faces the point, and a little larger than its equator.
    float from = length(to_center);
    plane.towards = to_center / from;
    plane.right = normalize(cross(plane.towards, abs(plane.towards.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0)));
    plane.up = cross(plane.right, plane.towards);
    plane.distance = from;
    plane.center = vec2(0.0);
    float share = half_size.x / from;
    plane.scale = vec2(sqrt(max(1.0 - share * share, 0.0)) / half_size.x);
    return plane;
  }
  plane.towards = -light.direction.xyz;
  plane.distance = dot(to_center, plane.towards);
  if (plane.distance < 0.0) {
    plane.towards = -plane.towards;
    plane.distance = -plane.distance;
  }
  plane.center = vec2(dot(to_center, plane.right), dot(to_center, plane.up));
  plane.scale = 1.0 / half_size;
  return plane;
}

// `offset` from the point to something before the plane, `depth` its part along `towards`.
vec2 onto_light(LightPlane plane, vec3 offset, float depth) {
  vec2 across = vec2(dot(offset, plane.right), dot(offset, plane.up));
  return (across * (plane.distance / depth) - plane.center) * plane.scale;
}
#endif
