// Share of the light that a silhouette edge covers or frees, seen from the surface in this pixel. The
// hard volume says whether the light's CENTRE is hidden. From there outwards, whatever lies beyond the
// edge is hidden where the centre is not, and free where it is: the edge adds or takes away that part
// of the light (Assarsson and Akenine-Moeller 2003), which a table knows.
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_volumes/light_side.glsl"
#include "renderer/shadow_volumes/coverage_table.glsl"

layout(location = 0) flat in vec3 edge_start;
layout(location = 1) flat in vec3 edge_end;
layout(location = 0) out float out_covered;
#ifdef WITH_COUNTS
layout(location = 1) out vec4 out_first_counts;
layout(location = 2) out vec4 out_second_counts;
#endif

uniform sampler2D geometry_position;

#ifdef WITH_COUNTS
// Adds `step` to every point of the light that lies beyond the line from a to b.
float[8] count_beyond(vec2 a, vec2 b, float step) {
  bool turned = a.x * b.y - a.y * b.x < 0.0;
  vec2 first = turned ? b : a;
  vec2 last = turned ? a : b;  // counter-clockwise after `first`, seen from the centre
  vec2 outwards = vec2(last.y - first.y, first.x - last.x);
  float packed[8] = float[8](0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  float place = step;
  for (int i = 0; i < coverage_point_count; ++i) {
    vec2 point = coverage_points[i].xy;
    // The rays through shared ends of neighbouring edges are tested alike: no point is lost.
    bool beyond = dot(point - first, outwards) > 0.0 && first.x * point.y - first.y * point.x >= 0.0 &&
                  last.x * point.y - last.y * point.x < 0.0;
    packed[i / counts_per_float] += beyond ? place : 0.0;
    place = i % counts_per_float == counts_per_float - 1 ? step : place * counts_per_place;
  }
  return packed;
}
#endif

void main() {
  vec4 surface = texel_of(geometry_position, ivec2(gl_FragCoord.xy));
  if (surface.w == 0.0) discard;
  LightPlane plane = light_plane(surface.xyz);
  vec3 start = edge_start - surface.xyz;
  vec3 end = edge_end - surface.xyz;
  float start_depth = dot(start, plane.towards);
  float end_depth = dot(end, plane.towards);
  // Only what lies between surface and light counts.
  float low = 1e-5 * rounding_length(plane, length(start) + length(end));
  float high = plane.end;
  if (max(start_depth, end_depth) <= low || min(start_depth, end_depth) >= high) discard;
  vec3 along = end - start;
  float rise = end_depth - start_depth;
  float first = 0.0;
  float last = 1.0;
  if (start_depth < low) first = (low - start_depth) / rise;
  if (start_depth > high) first = (high - start_depth) / rise;
  if (end_depth < low) last = (low - start_depth) / rise;
  if (end_depth > high) last = (high - start_depth) / rise;
  vec2 a = onto_light(plane, start + first * along, max(start_depth + first * rise, low));
  vec2 b = onto_light(plane, start + last * along, max(start_depth + last * rise, low));
  float beyond = part_beyond(a, b);
  if (beyond == 0.0) discard;
  bool center_hidden = side_of_plane(plane_of_edge(edge_start, edge_end), surface.xyz) < 0.0;
  out_covered = center_hidden ? -beyond : beyond;
#ifdef WITH_COUNTS
  float packed[8] = count_beyond(a, b, center_hidden ? -1.0 : 1.0);
  out_first_counts = vec4(packed[0], packed[1], packed[2], packed[3]);
  out_second_counts = vec4(packed[4], packed[5], packed[6], packed[7]);
#endif
}
