#ifndef PENUMBRA_RECEIVER_GLSL
#define PENUMBRA_RECEIVER_GLSL

// A planar receiver, as technique.cpp writes it.
struct ReceiverData {
  mat4 clip_from_caster;  // onto the plane from the light, then into the picture
  vec4 plane;             // xyz unit normal towards the receiving side, w distance from the origin
  vec4 heights;           // m: x lowest and y highest caster that counts, z tolerance; w corners
};

layout(std430) readonly buffer ReceiverBlock {
  ReceiverData receiver;
  vec4 sides[];  // planes through the polygon's sides, inside positive
};
#endif
