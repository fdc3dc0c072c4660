// Counters by which shaders report what must not happen; the frame reads them when it ends.
layout(std430) buffer FaultBlock {
  uint non_finite_pixels;       // shown as magenta
  uint unfinished_invocations;  // loops that ended before their work did: the render fails
};
