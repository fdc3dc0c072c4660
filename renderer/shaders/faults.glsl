// How shaders report what must not happen; the frame reads it when it ends.
layout(std430) buffer FaultBlock {
  uint unfinished_invocations;  // loops that ended before their work did: the render fails, or they are resumed
};
