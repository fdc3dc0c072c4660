// Input of the geometry shaders that draw volumes, and the silhouette edges of a triangle. Of closed
// meshes the triangles turned AWAY from the light are extruded: they have the same silhouette as the
// lit ones, and no cap then lies in a lit surface. Of open meshes every triangle is, turned towards the
// light first, so that sheets cast shadows whichever way they look; an edge between a triangle that had
// to be turned and one that had not is an edge of both. Following Bergeron 1986 and Kim et al. 2008,
// volumes are closed whatever the mesh.
//
// Defined by the preamble: EVERY_EDGE for plain triangles, of which the lit ones throw three sides each
// (van Sambeek 2007, 3.2.4, brute force); GAPS_IGNORED for open edges that throw no side.
#ifndef PENUMBRA_SILHOUETTE_GLSL
#define PENUMBRA_SILHOUETTE_GLSL
#include "renderer/shadow_volumes/facing.glsl"

#ifdef EVERY_EDGE
layout(triangles) in;
const int stride = 1;
#else
layout(triangles_adjacency) in;
const int stride = 2;
#endif

layout(location = 0) in vec3 world_position[];

// Whether this triangle throws a volume; `lit` tells which way it looks.
bool throws_volume(out bool lit) {
  vec3 a = world_position[0];
  vec3 b = world_position[stride];
  vec3 c = world_position[2 * stride];
  lit = false;
  if (a == b || b == c || c == a) return false;
  int side = light_side(a, b, c);
  lit = side > 0;
  if (side == 0) return false;
#ifdef EVERY_EDGE
  return lit;
#else
  return !lit || volume.every_triangle != 0u;
#endif
}

// Whether side k of the triangle is a silhouette; p and q are then the inputs between which it runs,
// with the triangle to the left as the light sees it.
bool is_silhouette(int k, bool lit, out int p, out int q) {
  int start = k * stride;
  int stop = (k + 1) % 3 * stride;
  // Seen from the light, the edge runs the way that it is wound only where the triangle is lit.
  p = lit ? start : stop;
  q = lit ? stop : start;
#ifdef EVERY_EDGE
  return true;
#else
  // An open edge names one of its own corners as neighbour. A neighbour that continues the surface
  // as the light sees it has the edge from q to p.
  vec3 other = world_position[start + 1];
  bool open = other == world_position[start] || other == world_position[stop];
#ifdef GAPS_IGNORED
  if (open) return false;
#endif
  return open || !is_lit(world_position[q], world_position[p], other);
#endif
}
#endif
