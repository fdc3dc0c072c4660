// The light, and what depends on its kind and its extent's: where it is, which way, how far, how large.
// The rest of the shaders asks here.
#ifndef PENUMBRA_LIGHT_GLSL
#define PENUMBRA_LIGHT_GLSL
#include "renderer/shaders/shader_types.h"

#if defined(CONSTANTS_FROM_VERTEX) && defined(PASSES_LIGHT) && defined(FRAGMENT_STAGE)
layout(location = light_location) flat in LightData light;
#else
layout(std140) uniform LightBlock { LightData light; };
#endif

int light_kind() { return int(light.position.w); }
int extent_kind() { return int(light.extent.x); }

// Whether all its rays are parallel: it has a direction, but no place.
bool is_at_infinity() { return light_kind() == light_kind_directional; }

// Position, or at infinity the unit direction to it.
vec3 light_center() { return is_at_infinity() ? -light.direction.xyz : light.position.xyz; }

// What distances along its rays are measured from: its centre, or the world's origin.
vec3 light_origin() { return is_at_infinity() ? vec3(0.0) : light.position.xyz; }

// From a point to the centre, m; at infinity the unit direction.
vec3 vector_to_light(vec3 position) {
  precise vec3 to_light = is_at_infinity() ? -light.direction.xyz : light.position.xyz - position;
  return to_light;
}
vec3 vector_from_light(vec3 position) {
  precise vec3 from_light = is_at_infinity() ? light.direction.xyz : position - light.position.xyz;
  return from_light;
}

// Moves the farther of two points along its ray to where the nearer is.
void level_with_light(inout vec3 a, inout vec3 b) {
  if (is_at_infinity()) {
    float offset = dot(b - a, light.direction.xyz);
    if (offset > 0.0) b -= offset * light.direction.xyz;
    else a += offset * light.direction.xyz;
    return;
  }
  vec3 from_a = a - light.position.xyz;
  vec3 from_b = b - light.position.xyz;
  float near = min(length(from_a), length(from_b));
  a = light.position.xyz + from_a * (near / max(length(from_a), 1e-30));
  b = light.position.xyz + from_b * (near / max(length(from_b), 1e-30));
}

// dot(a, b) in three operations: drivers that keep to IEEE 754 may not fuse those of dot themselves.
float fused_dot(vec3 a, vec3 b) { return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)); }

// 1 - cosine of an angle of 2 degrees.
const float narrow_cone = 6e-4;

struct Illumination {
  vec3 to_light;   // unit
  float distance;  // m; at infinity a distance beyond the scene
  float strength;  // cone, attenuation and range; 0 outside
};

// From `point` on the light: its position, or the direction to it at infinity. Without branches:
// a driver that runs lanes in step executes both sides anyway, and keeps what they share in memory.
Illumination illuminate(vec3 point, vec3 position) {
  bool directional = is_at_infinity();
  vec3 offset = mix(point - position, point, bvec3(directional));
  float squared = fused_dot(offset, offset);
  float inverse = inversesqrt(max(squared, 1e-30));
  Illumination result;
  result.to_light = mix(-light.direction.xyz, offset * inverse, bvec3(squared > 0.0));
  result.distance = mix(squared * inverse, 1e30, directional);
  bool attenuated = light.color.w > 0.5 && !directional;
  result.strength = mix(1.0, min(inverse * inverse, 1e12), attenuated);
  // As smoothstep, with a division that all points share.
  float cosine = -fused_dot(result.to_light, light.direction.xyz);
  float t = clamp((cosine - light.cone.y) * (1.0 / max(light.cone.x - light.cone.y, 1e-6)), 0.0, 1.0);
  // A narrow cone's cosines are equal as floats: the distance of two unit vectors is not.
  vec3 aside = result.to_light + light.direction.xyz;
  float versine = 0.5 * fused_dot(aside, aside);
  float narrow = clamp((light.up.w - versine) / max(light.up.w - light.right.w, 1e-6 * light.up.w), 0.0, 1.0);
  t = mix(t, narrow, light.up.w < narrow_cone && light.up.w > 0.0);
  bool spot = light_kind() == light_kind_spot;
  result.strength *= mix(1.0, t * t * fma(-2.0, t, 3.0), spot);
  bool beyond = light.direction.w > 0.0 && !directional && result.distance > light.direction.w;
  result.strength = mix(result.strength, 0.0, beyond);
  return result;
}

// No light comes to x from anywhere within `radius` of the centre, nor from the centre.
bool is_outside_light(vec3 x, float radius) {
  if (is_at_infinity()) return false;
  vec3 offset = x - light.position.xyz;
  if (light.direction.w > 0.0 && length(offset) - radius > light.direction.w) return true;
  if (light_kind() != light_kind_spot) return false;
  // Distance to the cone's mantle around the centre; a point's own cone is moved by radius at most.
  // From kilometres away neither squares of distances nor the cosine of so narrow a cone tell enough.
  float along = dot(offset, light.direction.xyz);
  float across = length(cross(offset, light.direction.xyz));
  float sine = sqrt(light.up.w * (2.0 - light.up.w));
  return across * light.cone.y - along * sine > radius + 1e-4 * (length(offset) + radius);
}

bool has_extent() { return extent_kind() != extent_kind_none; }

// Whether it fills the square from -1 to 1 in half sizes; otherwise the unit disc.
bool extent_is_square() { return extent_kind() == extent_kind_rectangle; }

// Half sizes along right and up: m, or tangents of the angle at infinity.
vec2 light_half_size() { return extent_is_square() ? light.extent.yz : light.extent.yy; }

// Radius of the sphere around the whole light, likewise.
float light_radius() {
  vec2 half_size = light_half_size();
  return extent_is_square() ? length(half_size) : half_size.x;
}

// Turns axes to those of the extent: a rectangle has its own, round ones look alike along any.
void turn_to_extent(inout vec3 right, inout vec3 up) {
  if (!extent_is_square()) return;
  right = light.right.xyz;
  up = light.up.xyz;
}

// Distance at which the half sizes are those of the extent: that of the light, m, or 1 at infinity.
float extent_distance(float light_distance) { return is_at_infinity() ? 1.0 : light_distance; }

// Tangents of the planes that touch the light past an edge across its rays, `height` from it: along the
// edge, and at its ends, `half_length` from the middle. False where the light reaches around on every side.
bool tangents_past_edge(float height, float half_length, out float across, out float outwards) {
  float radius = light_radius();
  across = radius;
  outwards = radius;
  if (is_at_infinity()) return true;
  if (height < 1.02 * radius) return false;
  across = radius / sqrt(height * height - radius * radius);
  float lean = asin(min(radius / length(vec2(height, half_length)), 1.0));
  outwards = tan(min(atan(half_length, height) + lean, 1.5690));
  return true;
}

// Perspective of a point onto the plane of the light, scaled so that the extent becomes the unit disc
// or the square from -1 to 1.
struct LightPlane {
  vec3 right, up;   // unit
  vec3 towards;     // unit, from the point to the plane
  float distance;   // m; 1 at infinity, where the plane is at no place
  float end;        // how far along `towards` the light is: m, 1e30 at infinity
  vec2 center;      // of the extent, before scaling
  vec2 scale;
};

LightPlane light_plane(vec3 position) {
  LightPlane plane;
  plane.right = light.right.xyz;
  plane.up = light.up.xyz;
  vec2 half_size = light_half_size();
  if (is_at_infinity()) {
    plane.towards = -light.direction.xyz;
    plane.distance = 1.0;
    plane.end = 1e30;
    plane.center = vec2(0.0);
    plane.scale = 1.0 / half_size;
    return plane;
  }
  vec3 to_center = light.position.xyz - position;
  if (extent_kind() == extent_kind_sphere) {
    // Seen from anywhere a ball is a disc that faces the point, and a little larger than its equator.
    float from = length(to_center);
    plane.towards = to_center / from;
    plane.right = normalize(cross(plane.towards, abs(plane.towards.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0)));
    plane.up = cross(plane.right, plane.towards);
    plane.distance = plane.end = from;
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
  plane.end = plane.distance;
  plane.center = vec2(dot(to_center, plane.right), dot(to_center, plane.up));
  plane.scale = 1.0 / half_size;
  return plane;
}

// `offset` from the point to something before the plane, `depth` its part along `towards`.
vec2 onto_light(LightPlane plane, vec3 offset, float depth) {
  vec2 across = vec2(dot(offset, plane.right), dot(offset, plane.up));
  return (across * (plane.distance / depth) - plane.center) * plane.scale;
}

// What rounding before the plane is relative to: its distance, or at infinity the size of what lies there.
float rounding_length(LightPlane plane, float size) { return is_at_infinity() ? size : plane.distance; }
#endif
