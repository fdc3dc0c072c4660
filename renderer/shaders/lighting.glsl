// The one shading model, the reference's included: Blinn-Phong in linear light.
#ifndef PENUMBRA_LIGHTING_GLSL
#define PENUMBRA_LIGHTING_GLSL
#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/geometry_buffer.glsl"
#include "renderer/shaders/light.glsl"

// Unit.
vec3 direction_to_viewer(vec3 position) {
  bool has_perspective = frame.camera_position.w > 0.5;
  return mix(-frame.camera_direction.xyz, normalize(frame.camera_position.xyz - position), bvec3(has_perspective));
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
