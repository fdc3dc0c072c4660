// The one shading model, the reference's included: Blinn-Phong in linear light.
#ifndef PENUMBRA_LIGHTING_GLSL
#define PENUMBRA_LIGHTING_GLSL
#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/geometry_buffer.glsl"

struct Illumination {
  vec3 to_light;   // unit
  float distance;  // m; for directional lights a distance beyond the scene
  float strength;  // cone, attenuation and range; 0 outside
};

// From `point` on the light: its position, or the direction to it when directional.
Illumination illuminate(LightData light, vec3 point, vec3 position) {
  Illumination result;
  if (int(light.position.w) == light_kind_directional) {
    result.to_light = point;
    result.distance = 1e30;
    result.strength = 1.0;
    return result;
  }
  vec3 offset = point - position;
  result.distance = length(offset);
  result.to_light = result.distance > 0.0 ? offset / result.distance : -light.direction.xyz;
  result.strength = light.color.w > 0.5 ? 1.0 / max(result.distance * result.distance, 1e-12) : 1.0;
  if (int(light.position.w) == light_kind_spot) {
    float cosine = -dot(result.to_light, light.direction.xyz);
    result.strength *= smoothstep(light.cone.y, max(light.cone.x, light.cone.y + 1e-6), cosine);
  }
  if (light.direction.w > 0.0 && result.distance > light.direction.w) result.strength = 0.0;
  return result;
}

// Light that leaves `surface` towards the viewer, unshadowed.
vec3 reflect_light(LightData light, Illumination incoming, Surface surface) {
  float n_dot_l = dot(surface.shading_normal, incoming.to_light);
  // The facet itself decides what faces the light, the shading normal how much: no light leaks
  // through a triangle that is turned away.
  if (n_dot_l <= 0.0 || dot(surface.geometric_normal, incoming.to_light) <= 0.0) return vec3(0.0);
  vec3 to_camera = frame.camera_position.w > 0.5 ? normalize(frame.camera_position.xyz - surface.position)
                                                 : -frame.camera_direction.xyz;
  vec3 halfway = normalize(incoming.to_light + to_camera);
  float highlight = pow(max(dot(surface.shading_normal, halfway), 0.0), surface.shininess);
  // (n + 8) / 8 keeps the energy of the highlight independent of the exponent.
  float specular = surface.specular * (surface.shininess + 8.0) / 8.0 * highlight;
  return light.color.rgb * incoming.strength * n_dot_l * (surface.base_color + vec3(specular));
}
#endif
