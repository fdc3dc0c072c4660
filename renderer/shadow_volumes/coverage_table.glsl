// Part of the light that lies beyond a piece of a straight line, seen from the light's centre: between
// the rays to its two ends, on the far side. The table holds it by the line's distance from the centre
// and the angle from the line's foot to an end, and for rectangles by the direction of the foot as
// well, so that an edge costs two look-ups. Written by coverage_table.cpp.
#ifndef PENUMBRA_COVERAGE_TABLE_GLSL
#define PENUMBRA_COVERAGE_TABLE_GLSL

#include "renderer/shadow_volumes/overlap_counts.glsl"

layout(std430) readonly buffer CoverageBlock {
  uvec4 coverage_size;      // x places along each axis, y directions (1: the light is round)
  vec4 coverage_range;      // x greatest distance, in half sizes of the light
  vec4 coverage_points[coverage_point_count];  // xy points of the light, likewise
  float coverage_values[];  // [direction][distance][angle], angle from -pi / 2 to pi / 2
};

float coverage_at(int direction, float distance_place, float angle_place) {
  int size = int(coverage_size.x);
  ivec2 cell = min(ivec2(distance_place, angle_place), ivec2(size - 2));
  vec2 part = vec2(distance_place, angle_place) - vec2(cell);
  int first = (direction * size + cell.x) * size + cell.y;
  vec2 near = vec2(coverage_values[first], coverage_values[first + 1]);
  vec2 far = vec2(coverage_values[first + size], coverage_values[first + size + 1]);
  vec2 both = mix(near, far, part.x);
  return mix(both.x, both.y, part.y);
}

// From the foot of the line to the end at this angle.
float part_to(float direction, float distance_place, float angle) {
  float angle_place = (angle / pi + 0.5) * float(coverage_size.x - 1u);
  if (coverage_size.y == 1u) return coverage_at(0, distance_place, angle_place);
  float direction_place = direction * float(coverage_size.y - 1u);
  int cell = min(int(direction_place), int(coverage_size.y) - 2);
  return mix(coverage_at(cell, distance_place, angle_place),
             coverage_at(cell + 1, distance_place, angle_place), direction_place - float(cell));
}

// Of the line from a to b, with the light around the origin.
float part_beyond(vec2 a, vec2 b) {
  vec2 along = b - a;
  float size = length(along);
  if (!(size > 0.0)) return 0.0;
  along /= size;
  vec2 foot = vec2(along.y, -along.x);  // unit, across the line
  float distance = a.x * foot.x + a.y * foot.y;
  if (distance < 0.0) {
    foot = -foot;
    distance = -distance;
  }
  if (distance >= coverage_range.x) return 0.0;
  vec2 turned = vec2(-foot.y, foot.x);
  float distance_place = distance / coverage_range.x * float(coverage_size.x - 1u);
  // A square looks the same after a quarter turn.
  float direction = fract(atan(foot.y, foot.x) / (0.5 * pi) + 4.0);
  return abs(part_to(direction, distance_place, atan(dot(b, turned), distance)) -
             part_to(direction, distance_place, atan(dot(a, turned), distance)));
}
#endif
