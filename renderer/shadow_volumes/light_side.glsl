// Which side of a triangle, or of the plane through the light and an edge, a point is on. Everyone who
// asks gets the same bits, whichever way the triangle or the edge is named.
#ifndef PENUMBRA_LIGHT_SIDE_GLSL
#define PENUMBRA_LIGHT_SIDE_GLSL
#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/light.glsl"

bool is_before(vec3 a, vec3 b) {
  return a.x < b.x || (a.x == b.x && (a.y < b.y || (a.y == b.y && a.z < b.z)));
}

// On which side of a triangle the light is: 1 where a, b, c runs counter-clockwise as seen from it, -1
// on the other, 0 where it lies in the plane: such a triangle is seen edge-on and throws no volume,
// whose end would be as wide as the world and have no area. Decided by the light's
// point against the triangle's own plane, not by a direction to one of its points, and with the
// corners sorted first: from any pass, in any order, gets the same bits, and a triangle is
// turned to the light exactly where its mirror image is not. So both sides of an edge always agree
// on whether it is a silhouette, and volumes have no gaps.
//
// FIRST_CORNER, from the preamble, takes the direction to the corner that is named first, in whatever
// order. On paper that comes to the same, for all corners lie in the plane; rounding decides otherwise.
#ifdef FIRST_CORNER
int light_side(vec3 a, vec3 b, vec3 c) {
  vec3 to_light = vector_to_light(a);
  return dot(cross(b - a, c - a), to_light) >= 0.0 ? 1 : -1;
}
#else
int light_side(vec3 a, vec3 b, vec3 c) {
  bool even = true;
  if (is_before(b, a)) { vec3 t = a; a = b; b = t; even = !even; }
  if (is_before(c, b)) { vec3 t = b; b = c; c = t; even = !even; }
  if (is_before(b, a)) { vec3 t = a; a = b; b = t; even = !even; }
  precise vec3 u = inverse_size() * (b - a);
  precise vec3 v = inverse_size() * (c - a);
  precise vec3 normal = vec3(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
  precise vec3 to_light = vector_to_light(a);
  precise float height = normal.x * to_light.x + normal.y * to_light.y + normal.z * to_light.z;
  // In the plane up to rounding: the sine of the angle to it.
  precise float lengths = length(normal) * length(to_light);
  if (abs(height) <= 3e-7 * lengths) return 0;
  return (height > 0.0) == even ? 1 : -1;
}
#endif

bool is_lit(vec3 a, vec3 b, vec3 c) { return light_side(a, b, c) > 0; }

// The plane through the light's centre and an edge.
struct EdgePlane {
  vec3 normal;  // not unit
  vec3 point;
};

EdgePlane plane_of_edge(vec3 start, vec3 end) {
  bool turned = is_before(end, start);
  vec3 a = turned ? end : start;
  vec3 b = turned ? start : end;
  precise vec3 u = vector_from_light(a);
  precise vec3 v = b - a;
  precise vec3 normal = vec3(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
  return EdgePlane(turned ? -normal : normal, a);
}

// Negative to the left of an edge that runs from start to end, as the light sees it; for the edge of a
// cap that is the side of the shadow.
float side_of_plane(EdgePlane plane, vec3 position) {
  precise vec3 from = position - plane.point;
  precise float side = plane.normal.x * from.x + plane.normal.y * from.y + plane.normal.z * from.z;
  return side;
}
#endif
