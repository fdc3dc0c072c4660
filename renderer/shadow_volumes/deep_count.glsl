// Steps of a count that an image adds up by blending, where the stencil's bits are too few.
#ifndef PENUMBRA_DEEP_COUNT_GLSL
#define PENUMBRA_DEEP_COUNT_GLSL
#ifdef DEEP_COUNT
layout(location = 0) out float out_step;

void count_step() { out_step = gl_FrontFacing ? FRONT_STEP : BACK_STEP; }
#else
void count_step() {}
#endif
#endif
