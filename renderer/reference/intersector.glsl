// Exact visibility of many light points at once. A receiver and the box around the points span a shaft;
// the walk finds triangles that reach into it, and each is tested against all points by four planes:
// three through the receiver and an edge, and the triangle's own. Lengths are in units near the scene's
// size: planes are products of three.
#ifndef PENUMBRA_INTERSECTOR_GLSL
#define PENUMBRA_INTERSECTOR_GLSL

uniform usamplerBuffer hierarchy_nodes;      // two texels each: low and next, high and triangle
uniform usamplerBuffer hierarchy_triangles;  // three texels each: corner; w of the first: hole data

// The union of the segments from `origin` to all points of a box, or of the rays along all directions
// in it. A box [a, b] is met at parameter t where t low_rate <= b - origin and t high_rate >= a - origin
// on every axis: six bounds of t.
struct Shaft {
  vec3 origin;
  float finite;            // 1 for positions, 0 for directions
  vec3 middle, half_size;  // box of positions or directions
  vec3 inverse_low, inverse_high;
  bvec3 low_is_upper, high_is_lower;  // which way the bounds face
  float end;                          // largest t
  float rounding;                     // how far the origin may lie from its surface
};

Shaft make_shaft(vec3 origin, vec3 low, vec3 high, float finite, float rounding) {
  Shaft s;
  s.origin = origin;
  s.rounding = rounding;
  s.finite = finite;
  s.middle = 0.5 * low + 0.5 * high;
  s.half_size = 0.5 * high - 0.5 * low;
  vec3 low_rate = low - finite * origin;
  vec3 high_rate = high - finite * origin;
  // A rate of zero bounds nothing or all: a tiny one does the same without 0 / 0.
  const float tiny = 1e-20;
  low_rate = mix(low_rate, vec3(tiny), lessThan(abs(low_rate), vec3(tiny)));
  high_rate = mix(high_rate, vec3(tiny), lessThan(abs(high_rate), vec3(tiny)));
  s.inverse_low = 1.0 / low_rate;
  s.inverse_high = 1.0 / high_rate;
  s.low_is_upper = greaterThan(low_rate, vec3(0.0));
  s.high_is_lower = greaterThan(high_rate, vec3(0.0));
  s.end = finite > 0.5 ? 1.0 : 1e30;
  return s;
}

bool meets(Shaft s, vec3 low, vec3 high) {
  vec3 a = (high - s.origin) * s.inverse_low;
  vec3 b = (low - s.origin) * s.inverse_high;
  vec3 upper = min(mix(vec3(s.end), a, s.low_is_upper), mix(b, vec3(s.end), s.high_is_lower));
  vec3 lower = max(mix(a, vec3(0.0), s.low_is_upper), mix(vec3(0.0), b, s.high_is_lower));
  // The factor covers rounding; boxes that only touch must count.
  return max(max(lower.x, lower.y), max(lower.z, 0.0)) <=
         1.00001 * min(min(upper.x, upper.y), upper.z);
}

// A point p of the light is hidden by a triangle where all edges are >= 0 and beyond > 0 of (p, 1).
struct TrianglePlanes {
  vec4 edges[3];
  vec4 beyond;
};

float at(vec4 plane, vec3 p) {
  return fma(plane.z, p.z, fma(plane.y, p.y, fma(plane.x, p.x, plane.w)));
}

// The plane through x, b and c. Swapping b and c gives the exact negative, so that a ray on an edge
// which two triangles share is caught by one of them (as Embree's Pluecker test does).
vec4 edge_plane(Shaft s, vec3 b, vec3 c) {
  vec3 normal = cross(c - b, (b - s.origin) + (c - s.origin));
  return vec4(-normal, s.finite * dot(normal, s.origin));
}

float longest(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

// Of a triangle's plane, whose corners are rounded, no more is known than this sine of the angle from a
// corner. It is several roundings wide.
const float in_plane = 4e-7;

TrianglePlanes planes_of(Shaft s, uint triangle) {
  int first = int(3u * triangle);
  vec3 a = uintBitsToFloat(texelFetch(hierarchy_triangles, first).xyz);
  vec3 b = uintBitsToFloat(texelFetch(hierarchy_triangles, first + 1).xyz);
  vec3 c = uintBitsToFloat(texelFetch(hierarchy_triangles, first + 2).xyz);
  vec3 normal = cross(b - a, c - a);
  float side = dot(normal, a - s.origin);
  // A triangle seen edge-on, or without area, hides nothing: its sign is 0 and so are its planes. Such
  // is the receiver's own, and its neighbours in the same plane.
  float doubt = in_plane * longest(b - a) * longest(c - a) * longest(a - s.origin) + s.rounding * length(normal);
  float sign_of_side = abs(side) <= doubt ? 0.0 : sign(side);
  TrianglePlanes t;
  t.edges[0] = sign_of_side * edge_plane(s, b, c);
  t.edges[1] = sign_of_side * edge_plane(s, c, a);
  t.edges[2] = sign_of_side * edge_plane(s, a, b);
  t.beyond = sign_of_side * vec4(normal, -s.finite * dot(normal, a));
  return t;
}

// What rounding may do to a plane's value at a point whose coordinates are no larger than `farthest`.
float range_margin(vec4 plane, vec3 farthest) { return 1e-6 * (dot(abs(plane.xyz), farthest) + abs(plane.w)); }

// Least and greatest value of a plane over the shaft's box, widened by what rounding may do.
vec2 range_of(Shaft s, vec4 plane) {
  float value = at(plane, s.middle);
  float spread = dot(abs(plane.xyz), s.half_size) + range_margin(plane, abs(s.middle));
  return vec2(value - spread, value + spread);
}

const int hides_none = 0;
const int hides_some = 1;
const int hides_all = 2;

int classify(Shaft s, TrianglePlanes t) {
  vec2 range = range_of(s, t.beyond);
  for (int i = 0; i < 3; ++i) range = min(range, range_of(s, t.edges[i]));
  if (range.y < 0.0 || t.beyond.xyz == vec3(0.0)) return hides_none;
  return range.x > 0.0 ? hides_all : hides_some;
}

// Rounds that the loops of a walk may take still: a walk that needs more is to be resumed by another
// dispatch.
int rounds_left = 0x7fffffff;

// Looks at a node and goes on to the next: the triangle of a leaf whose box the shaft meets, otherwise -1.
// Boxes were widened against rounding when they were written.
int step_node(Shaft s, inout uint node) {
  uvec4 low = texelFetch(hierarchy_nodes, int(2u * node));
  uvec4 high = texelFetch(hierarchy_nodes, int(2u * node + 1u));
  bool inside = meets(s, uintBitsToFloat(low.xyz), uintBitsToFloat(high.xyz));
  int triangle = inside ? int(high.w) : -1;
  // Without branches: a driver that runs lanes in step executes both sides anyway.
  node = inside && triangle < 0 ? node + 1u : low.w;
  return triangle;
}

// Goes on from `node` to the next leaf before `end` that the shaft meets; -1 if there is none, or no rounds
// are left.
int next_leaf(Shaft s, inout uint node, uint end) {
  int triangle = -1;
  while (node < end && triangle < 0 && rounds_left > 0) {
    --rounds_left;
    triangle = step_node(s, node);
  }
  return triangle;
}
#endif
