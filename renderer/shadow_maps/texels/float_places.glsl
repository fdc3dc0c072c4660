// Floats that integers have atomic minima and maxima of everywhere.
#ifndef PENUMBRA_FLOAT_PLACES_GLSL
#define PENUMBRA_FLOAT_PLACES_GLSL
/// Place of a float in the order of all floats.
uint place_of(float value) {
  uint bits = floatBitsToUint(value);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float float_at(uint place) {
  return uintBitsToFloat((place & 0x80000000u) != 0u ? place & 0x7fffffffu : ~place);
}
#endif
