// For programs that draw casters. With MASKED, holes of alpha-masked materials are cut out: the vertex stage
// calls pass_holes, the fragment stage cut_holes. What a material has arrives flat: lavapipe reads a buffer in
// fragments once for each lane.
#ifndef PENUMBRA_CASTER_GLSL
#define PENUMBRA_CASTER_GLSL
#include "renderer/shaders/frame.glsl"

#ifndef MASKED
void pass_holes() {}
void cut_holes() {}
#elif defined(VERTEX_STAGE)
layout(std430) readonly buffer MaterialBlock { MaterialData materials[]; };
layout(push_constant) uniform DrawBlock { uint material; } draw;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;
layout(location = 1) out vec2 surface_uv;
layout(location = 2) out float vertex_alpha;
layout(location = 3) flat out vec3 hole;

void pass_holes() {
  MaterialData material = materials[draw.material];
  surface_uv = uv;
  vertex_alpha = color.a;
  hole = vec3(material.base_color.a, material.surface.zw);
}
#else
uniform sampler2D surface_texture;
layout(location = 1) in vec2 surface_uv;
layout(location = 2) in float vertex_alpha;
layout(location = 3) flat in vec3 hole;  // alpha, its cutoff, 1 with a texture

void cut_holes() {
  float alpha = hole.x * vertex_alpha;
  if (hole.z > 0.5) alpha *= texture(surface_texture, surface_uv).a;
  if (alpha < hole.y) discard;
}
#endif
#endif
