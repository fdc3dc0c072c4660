// Running sums along the lines of a table, in place: along rows, where values come from the depth map,
// or with COLUMNS along columns. A group works on eight lines at once, each cut into parts: parts are
// summed, what lies before a part is the sum of the parts before it, then its own values are added one
// by one.
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/filters/summed_area_types.glsl"

const int lines = 8;
const int parts = 32;
layout(local_size_x = 8, local_size_y = 32) in;  // lines, parts

layout(std430) buffer SummedAreaBlock { TableSum summed_area[]; };
layout(push_constant) uniform TableBlock { int size; } table;
#ifndef COLUMNS
uniform sampler2DArray shadow_map;
#endif

shared TableSum sums[parts * lines];

int entry(int line, int place, int view) {
#ifdef COLUMNS
  return (view * table.size + place) * table.size + line;
#else
  return (view * table.size + line) * table.size + place;
#endif
}

TableSum value_of(int line, int place, int view) {
#ifdef COLUMNS
  return summed_area[entry(line, place, view)];
#else
  float depth = texel_of(shadow_map, ivec3(place, line, view)).r;
  return table_value(vec2(depth, depth * depth), table.size);
#endif
}

void main() {
  int lane = int(gl_LocalInvocationID.x);
  int part = int(gl_LocalInvocationID.y);
  int view = int(gl_WorkGroupID.y);
  int line = int(gl_WorkGroupID.x) * lines + lane;
  int length = (table.size + parts - 1) / parts;
  int first = part * length;
  int end = line < table.size ? min(first + length, table.size) : first;

  TableSum sum = TableSum(0);
  for (int place = first; place < end; ++place) sum += value_of(line, place, view);
  sums[part * lines + lane] = sum;
  barrier();
  sum = TableSum(0);
  for (int before = 0; before < part; ++before) sum += sums[before * lines + lane];
  for (int place = first; place < end; ++place) {
    sum += value_of(line, place, view);
    summed_area[entry(line, place, view)] = sum;
  }
}
