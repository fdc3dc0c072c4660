// Values of a map as its format keeps them, with the parameter precision.
#ifndef PENUMBRA_HALF_RANGE_GLSL
#define PENUMBRA_HALF_RANGE_GLSL

/// What 16 bits cannot hold becomes infinite here already: drivers may round it to the greatest value
/// that they can.
float in_format(float value) {
  const float greatest = 65504.0;
  if (parameter_precision == precision_fp16 && value > greatest) return uintBitsToFloat(0x7f800000u);
  return value;
}
#endif
