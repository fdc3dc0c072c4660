// For programs that draw casters. With MASKED, holes of alpha-masked materials are cut out.
#ifndef PENUMBRA_CASTER_GLSL
#define PENUMBRA_CASTER_GLSL
#include "renderer/shaders/frame.glsl"

#ifdef MASKED
layout(std430) readonly buffer MaterialBlock { MaterialData materials[]; };
uniform sampler2D surface_texture;
#endif
#endif
