// Percentage-closer filters: every texel is compared first, and the results are averaged.
#ifndef PENUMBRA_MAP_FILTERS_GLSL
#define PENUMBRA_MAP_FILTERS_GLSL
#include "renderer/shadow_maps/depth_map.glsl"

/// Mean over size x size texels around the receiver's place: around the texel that it falls into for
/// odd sizes, around the nearest corner for even ones.
float mean_of_box(MapPoint point, int size) {
  ivec2 first = ivec2(floor(point.texel - 0.5 * float(size - 1)));
  float lit = 0.0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) lit += compare_texel(point, first + ivec2(x, y));
  return lit / float(size * size);
}

/// The place between texels that samplers make of one: they know 1/256 of a texel.
vec2 sampled_place(vec2 texel) { return round(256.0 * texel) / 256.0; }

/// Mean over size x size bilinear comparisons a texel apart. Neighbouring ones share texels: it is a
/// mean over (size + 1)^2 texels of which the outermost count by the share that they are covered.
float mean_of_bilinear(MapPoint point, int size) {
  vec2 corner = sampled_place(point.texel) - 0.5 * float(size);
  ivec2 first = ivec2(floor(corner));
  vec2 share = corner - vec2(first);
  float lit = 0.0;
  for (int y = 0; y <= size; ++y) {
    float row = y == 0 ? 1.0 - share.y : y == size ? share.y : 1.0;
    for (int x = 0; x <= size; ++x) {
      float column = x == 0 ? 1.0 - share.x : x == size ? share.x : 1.0;
      lit += row * column * compare_texel(point, first + ivec2(x, y));
    }
  }
  return lit / float(size * size);
}

/// Angle of 0 to 2 pi by which this pixel's taps are turned: neighbours differ as much as they can
/// (interleaved gradient noise, Jimenez 2014).
float tap_rotation(vec2 pixel) {
  pixel += frame.window.xy;
  return 2.0 * pi * fract(52.9829189 * fract(dot(floor(pixel), vec2(0.06711056, 0.00583715))));
}

/// Taps spread evenly over the unit disc along a sunflower's spiral (Vogel 1979): each lies by the golden angle
/// further around than the one before.
vec2 direction_of_first_tap(float rotation) { return vec2(cos(rotation), sin(rotation)); }
vec2 direction_of_next_tap(vec2 direction) {
  const vec2 golden = vec2(-0.73736887807831985597, 0.67549029426152362720);
  return vec2(golden.x * direction.x - golden.y * direction.y, golden.y * direction.x + golden.x * direction.y);
}
/// How far the i-th of n lies from the middle.
float length_of_tap(int i, int n) { return sqrt((float(i) + 0.5) * (1.0 / float(n))); }

/// Mean over taps within `radius` texels, each compared with the texel that it falls into.
float mean_of_disc(MapPoint point, float radius, int taps, float rotation) {
  float lit = 0.0;
  vec2 direction = direction_of_first_tap(rotation);
  for (int i = 0; i < taps; ++i, direction = direction_of_next_tap(direction))
    lit += compare_texel(point, ivec2(floor(point.texel + radius * length_of_tap(i, taps) * direction)));
  return lit / float(taps);
}
#endif
