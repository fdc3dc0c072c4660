// The one shading model, the reference's included: Blinn-Phong in linear light.
#ifndef PENUMBRA_LIGHTING_GLSL
#define PENUMBRA_LIGHTING_GLSL
#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/geometry_buffer.glsl"

// dot(a, b) in three operations: drivers that keep to IEEE 754 may not fuse those of dot themselves.
float fused_dot(vec3 a, vec3 b) { return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)); }

// 1 - cosine of an angle of 2 degrees.
const float narrow_cone = 6e-4;

struct Illumination {
  vec3 to_light;   // unit
  float distance;  // m; for directional lights a distance beyond the scene
  float strength;  // cone, attenuation and range; 0 outside
};

// From `point` on the light: its position, or the direction to it when directional. Without branches:
// a driver that runs lanes in step executes both sides anyway, and keeps what they share in memory.
Illumination illuminate(LightData light, vec3 point, vec3 position) {
  bool directional = int(light.position.w) == light_kind_directional;
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
  bool spot = int(light.position.w) == light_kind_spot;
  result.strength *= mix(1.0, t * t * fma(-2.0, t, 3.0), spot);
  bool beyond = light.direction.w > 0.0 && !directional && result.distance > light.direction.w;
  result.strength = mix(result.strength, 0.0, beyond);
  return result;
}

// Unit.
vec3 direction_to_viewer(vec3 position) {
  return frame.camera_position.w > 0.5 ? normalize(frame.camera_position.xyz - position)
                                       : -frame.camera_direction.xyz;
}

// Share of white light from `to_light` that goes to the viewer: x by the base colour, y by the
// highlight. Both take the cosine into account.
vec2 reflected_shares(Surface surface, vec3 to_viewer, vec3 to_light) {
  float n_dot_l = fused_dot(surface.shading_normal, to_light);
  // n . h with h halfway between two unit vectors, whose sum has the squared length 2 + 2 l . v.
  float n_dot_h = (n_dot_l + dot(surface.shading_normal, to_viewer)) *
                  inversesqrt(max(fma(2.0, fused_dot(to_light, to_viewer), 2.0), 1e-12));
  float highlight = pow(clamp(n_dot_h, 0.0, 1.0), surface.shininess);
  // The facet itself decides what faces the light, the shading normal how much: no light leaks
  // through a triangle that is turned away.
  bool faces = n_dot_l > 0.0 && fused_dot(surface.geometric_normal, to_light) > 0.0;
  return mix(0.0, n_dot_l, faces) * vec2(1.0, highlight);
}

// What a surface makes of shares that were summed over points of a light.
vec3 colored(LightData light, Surface surface, vec2 shares) {
  // (n + 8) / 8 keeps the energy of the highlight independent of the exponent.
  float specular = surface.specular * (surface.shininess + 8.0) / 8.0;
  return light.color.rgb * (shares.x * surface.base_color + vec3(shares.y * specular));
}

// Light that leaves `surface` towards the viewer, unshadowed.
vec3 reflect_light(LightData light, Illumination incoming, Surface surface) {
  vec2 shares = reflected_shares(surface, direction_to_viewer(surface.position), incoming.to_light);
  return colored(light, surface, incoming.strength * shares);
}
#endif
