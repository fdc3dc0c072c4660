// Where the levels of the chain lie: side by side in one image, each half as wide as the one before it.
// Levels of a mip chain would not do: lavapipe reads one level for all four pixels of a quad.
#ifndef PENUMBRA_NEAREST_DEPTHS_LAYOUT_GLSL
#define PENUMBRA_NEAREST_DEPTHS_LAYOUT_GLSL
ivec2 level_offset(int level, int base) { return ivec2(2 * base - (2 * base >> level), 0); }
#endif
