// f(0) f(1) ... f(31). Drivers share what unrolled code has in common: hence no loop.
#ifndef PENUMBRA_UNROLL_GLSL
#define PENUMBRA_UNROLL_GLSL
#define UNROLL_4(f, i) f(i) f(i + 1) f(i + 2) f(i + 3)
#define UNROLL_32(f)                                                                  \
  UNROLL_4(f, 0) UNROLL_4(f, 4) UNROLL_4(f, 8) UNROLL_4(f, 12) UNROLL_4(f, 16) \
  UNROLL_4(f, 20) UNROLL_4(f, 24) UNROLL_4(f, 28)
#endif
