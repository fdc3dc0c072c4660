// Where the mask of a sample is among all of the frame.
#ifndef PENUMBRA_MASK_PLACE_GLSL
#define PENUMBRA_MASK_PLACE_GLSL
#include "renderer/shaders/frame.glsl"

uint mask_place(ivec2 texel) { return uint(texel.y) * uint(frame.size.x) + uint(texel.x); }
#endif
