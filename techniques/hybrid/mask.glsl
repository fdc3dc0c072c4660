#ifndef PENUMBRA_MASK_GLSL
#define PENUMBRA_MASK_GLSL
// Values of the mask, stored in eight bits.
const float mask_dark = 0.0;
const float mask_silhouette = 0.2;
const float mask_lit = 1.0;

bool is_silhouette_mask(float mask) { return abs(mask - mask_silhouette) < 0.01; }
#endif
