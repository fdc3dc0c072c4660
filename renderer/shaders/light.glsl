// The light, and what depends on its kind and its extent's: where it is, which way, how far, how large.
// The rest of the shaders asks here. What depends on the light alone is chosen without branches: Mesa 22.3
// compiles a program anew for every draw where constants alone decide a branch (decision 67).
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
vec3 light_center() { return mix(light.position.xyz, -light.direction.xyz, bvec3(is_at_infinity())); }

// What distances along its rays are measured from: its centre, or the world's origin.
vec3 light_origin() { return mix(light.position.xyz, vec3(0.0), bvec3(is_at_infinity())); }

// From a point to the centre, m; at infinity the unit direction.
vec3 vector_to_light(vec3 position) {
  precise vec3 to_light = mix(light.position.xyz - position, -light.direction.xyz, bvec3(is_at_infinity()));
  return to_light;
}
vec3 vector_from_light(vec3 position) {
  precise vec3 from_light = mix(position - light.position.xyz, light.direction.xyz, bvec3(is_at_infinity()));
  return from_light;
}

// Moves the farther of two points along its ray to where the nearer is.
void level_with_light(inout vec3 a, inout vec3 b) {
  bvec3 parallel = bvec3(is_at_infinity());
  float offset = dot(b - a, light.direction.xyz);
  vec3 moved_a = a + min(offset, 0.0) * light.direction.xyz;
  vec3 moved_b = b - max(offset, 0.0) * light.direction.xyz;
  vec3 from_a = a - light.position.xyz;
  vec3 from_b = b - light.position.xyz;
  float near = min(length(from_a), length(from_b));
  a = mix(light.position.xyz + from_a * (near / max(length(from_a), 1e-30)), moved_a, parallel);
  b = mix(light.position.xyz + from_b * (near / max(length(from_b), 1e-30)), moved_b, parallel);
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
  bool falls_off = light.color.w > 0.5;
  bool attenuated = falls_off && !directional;
  result.strength = mix(1.0, min(inverse * inverse, 1e12), attenuated);
  // As smoothstep, with a division that all points share.
  float cosine = -fused_dot(result.to_light, light.direction.xyz);
  float t = clamp((cosine - light.cone.y) * (1.0 / max(light.cone.x - light.cone.y, 1e-6)), 0.0, 1.0);
  // A narrow cone's cosines are equal as floats: the distance of two unit vectors is not.
  vec3 aside = result.to_light + light.direction.xyz;
  float versine = 0.5 * fused_dot(aside, aside);
  float narrow = clamp((light.up.w - versine) / max(light.up.w - light.right.w, 1e-6 * light.up.w), 0.0, 1.0);
  bool is_narrow = light.up.w < narrow_cone, has_cone = light.up.w > 0.0;
  t = mix(t, narrow, is_narrow && has_cone);
  bool spot = light_kind() == light_kind_spot;
  result.strength *= mix(1.0, t * t * fma(-2.0, t, 3.0), spot);
  bool ends = light.direction.w > 0.0, past_end = result.distance > light.direction.w;
  bool beyond = ends && past_end && !directional;
  result.strength = mix(result.strength, 0.0, beyond);
  return result;
}

// No light comes to x from anywhere within `radius` of the centre, nor from the centre. Without branches.
bool is_outside_light(vec3 x, float radius) {
  vec3 offset = x - light.position.xyz;
  float from = length(offset);
  bool beyond = from - radius > mix(1e30, light.direction.w, light.direction.w > 0.0);
  // Distance to the cone's mantle around the centre; a point's own cone is moved by radius at most.
  // From kilometres away neither squares of distances nor the cosine of so narrow a cone tell enough.
  float along = dot(offset, light.direction.xyz);
  float across = length(cross(offset, light.direction.xyz));
  float sine = sqrt(light.up.w * (2.0 - light.up.w));
  bool aside = across * light.cone.y - along * sine > radius + 1e-4 * (from + radius);
  bool spot = light_kind() == light_kind_spot;
  bool parallel = is_at_infinity();
  bool beside = spot && aside;
  bool outside = beyond || beside;
  return outside && !parallel;
}

bool has_extent() { return extent_kind() != extent_kind_none; }

// Whether it fills the square from -1 to 1 in half sizes; otherwise the unit disc.
bool extent_is_square() { return extent_kind() == extent_kind_rectangle; }

// Half sizes along right and up: m, or tangents of the angle at infinity.
vec2 light_half_size() { return mix(light.extent.yy, light.extent.yz, bvec2(extent_is_square())); }

// Radius of the sphere around the whole light, likewise.
float light_radius() {
  vec2 half_size = light_half_size();
  return mix(half_size.x, length(half_size), extent_is_square());
}

// Turns axes to those of the extent: a rectangle has its own, round ones look alike along any.
void turn_to_extent(inout vec3 right, inout vec3 up) {
  bvec3 square = bvec3(extent_is_square());
  right = mix(right, light.right.xyz, square);
  up = mix(up, light.up.xyz, square);
}

// Distance at which the half sizes are those of the extent: that of the light, m, or 1 at infinity.
float extent_distance(float light_distance) { return mix(light_distance, 1.0, is_at_infinity()); }

// Tangents of the planes that touch the light past an edge across its rays, `height` from it: along the
// edge, and at its ends, `half_length` from the middle. False where the light reaches around on every side:
// they are undefined then.
bool tangents_past_edge(float height, float half_length, out float across, out float outwards) {
  float radius = light_radius();
  bool parallel = is_at_infinity();
  bool is_around = height < 1.02 * radius;
  across = mix(radius / sqrt(height * height - radius * radius), radius, parallel);
  float lean = asin(min(radius / length(vec2(height, half_length)), 1.0));
  outwards = mix(tan(min(atan(half_length, height) + lean, 1.5690)), radius, parallel);
  return parallel || !is_around;
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
  bool parallel = is_at_infinity();
  bool is_ball = extent_kind() == extent_kind_sphere;
  bvec3 ball = bvec3(is_ball && !parallel);
  vec2 half_size = light_half_size();
  vec3 to_center = light.position.xyz - position;
  float from = length(to_center);
  // Seen from anywhere a ball is a disc that faces the point, and a little larger than its equator.
  vec3 facing = to_center / from;
  vec3 sideways = normalize(cross(facing, mix(vec3(0, 1, 0), vec3(1, 0, 0), bvec3(abs(facing.x) < 0.6))));
  float share = half_size.x / from;
  vec2 ball_scale = vec2(sqrt(max(1.0 - share * share, 0.0)) / half_size.x);

  float along = dot(to_center, -light.direction.xyz);
  bool turned = along < 0.0 && !parallel;
  LightPlane plane;
  plane.right = mix(light.right.xyz, sideways, ball);
  plane.up = mix(light.up.xyz, cross(sideways, facing), ball);
  plane.towards = mix(mix(-light.direction.xyz, light.direction.xyz, bvec3(turned)), facing, ball);
  plane.distance = mix(mix(abs(along), from, ball.x), 1.0, parallel);
  plane.end = mix(plane.distance, 1e30, parallel);
  vec2 center = vec2(dot(to_center, plane.right), dot(to_center, plane.up));
  bool centered = ball.x || parallel;
  plane.center = mix(center, vec2(0.0), bvec2(centered));
  plane.scale = mix(1.0 / half_size, ball_scale, ball.xy);
  return plane;
}

// `offset` from the point to something before the plane, `depth` its part along `towards`.
vec2 onto_light(LightPlane plane, vec3 offset, float depth) {
  vec2 across = vec2(dot(offset, plane.right), dot(offset, plane.up));
  return (across * (plane.distance / depth) - plane.center) * plane.scale;
}

// What rounding before the plane is relative to: its distance, or at infinity the size of what lies there.
float rounding_length(LightPlane plane, float size) { return mix(plane.distance, size, is_at_infinity()); }
#endif
