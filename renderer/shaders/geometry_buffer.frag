#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/geometry_buffer.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in vec2 surface_uv;
layout(location = 3) in vec4 vertex_color;

layout(location = 0) out vec4 out_position;
layout(location = 1) out uvec4 out_words;
layout(location = 2) out vec4 out_radiance;

layout(std430) readonly buffer MaterialBlock { MaterialData materials[]; };
#ifdef TEXTURED
uniform sampler2D surface_texture;
#endif
layout(push_constant) uniform DrawBlock { uint material; } draw;

// Textures and materials arrive decoded once; the gamma parameter may ask for none or twice.
vec3 decoded(vec3 linear_color) {
#if DECODES == 0
  return srgb_from_linear(linear_color);
#elif DECODES == 2
  return linear_from_srgb(linear_color);
#else
  return linear_color;
#endif
}

// Of interpolated positions, relative: several units in their last place.
const float position_rounding = 4.8e-7;

void main() {
  MaterialData material = materials[draw.material];
  vec4 color = material.base_color * vertex_color;
#ifdef TEXTURED
  vec4 texel = texture(surface_texture, surface_uv);
#ifdef TEXTURES_AS_STORED
  texel.rgb = srgb_from_linear(texel.rgb);
#endif
  color *= texel;
#endif
#ifdef MASKED
  if (color.a < material.surface.z) discard;
#endif

  // The facet's normal from its own plane; gl_PrimitiveID would give it exactly, but lavapipe loses it
  // in clipped triangles. Both normals look towards the viewer.
  vec3 right = inverse_size() * dFdx(world_position), down = inverse_size() * dFdy(world_position);
  vec3 across = cross(right, down);
  vec3 facet = normalize(across);
  vec3 to_camera = frame.camera_position.w > 0.5 ? frame.camera_position.xyz - world_position
                                                 : -frame.camera_direction.xyz;
  if (dot(facet, to_camera) < 0.0) facet = -facet;
  vec3 normal = normalize(world_normal);
  if (!gl_FrontFacing) normal = -normal;
  if (dot(normal, facet) < 0.0) normal = facet;
  // Differences of positions lose what a flat facet's normal, given with its corners, still has.
  float doubt = position_rounding * inverse_size() * length(world_position) *
                max(length(right), length(down)) / max(length(across), 1e-30);
  float bend = max(length(dFdx(world_normal)), length(dFdy(world_normal)));
  if (max(length(normal - facet), bend) < doubt) facet = normal;

  Surface surface;
  surface.position = world_position;
  surface.shading_normal = normal;
  surface.geometric_normal = facet;
  surface.base_color = decoded(color.rgb);
  surface.specular = material.surface.x;
  surface.shininess = material.surface.y;
  pack_surface(surface, out_position, out_words);
  out_radiance = vec4(frame.ambient.rgb * surface.base_color + material.emissive.rgb, 1.0);
}
