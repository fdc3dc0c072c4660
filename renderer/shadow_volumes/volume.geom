// Shadow volume of a triangle with adjacency: caps at the triangle and at the shadow's end, and a
// side along every silhouette edge. Of closed meshes the triangles turned AWAY from the light are
// extruded: they have the same silhouette as the lit ones, and no cap then lies in a lit surface.
// Of open meshes every triangle is, turned towards the light first, so that sheets cast shadows
// whichever way they look; an edge between a triangle that had to be turned and one that had not is
// an edge of both. Following Bergeron 1986 and Kim et al. 2008, volumes are closed whatever the mesh.
//
// Defined by the preamble: WITH_CAPS for counting on depth fail; EVERY_EDGE for plain triangles, of
// which the lit ones throw three sides each (van Sambeek 2007, 3.2.4, brute force).
#include "renderer/shadow_volumes/facing.glsl"

#ifdef EVERY_EDGE
layout(triangles) in;
const int stride = 1;
#else
layout(triangles_adjacency) in;
const int stride = 2;
#endif
layout(triangle_strip, max_vertices = 24) out;

layout(location = 0) in vec3 world_position[];

void emit(vec4 a, vec4 b, vec4 c) {
  gl_Position = a;
  EmitVertex();
  gl_Position = b;
  EmitVertex();
  gl_Position = c;
  EmitVertex();
  EndPrimitive();
}

// Side that runs along p to q of a cap seen from the light. The same two triangles are emitted for
// q to p, each with two corners swapped: where sides of neighbouring volumes coincide, so do their
// depths, and they cancel in every pixel.
void emit_side(int p, int q, vec4 p_end, vec4 q_end) {
  vec4 p_clip = gl_in[p].gl_Position;
  vec4 q_clip = gl_in[q].gl_Position;
  if (is_before(world_position[q], world_position[p])) {
    emit(q_clip, p_clip, p_end);
    emit(q_clip, p_end, q_end);
  } else {
    emit(p_clip, q_end, q_clip);
    emit(p_clip, p_end, q_end);
  }
}

void main() {
  vec3 a = world_position[0];
  vec3 b = world_position[stride];
  vec3 c = world_position[2 * stride];
  if (a == b || b == c || c == a) return;
  bool lit = is_lit(a, b, c);
#ifdef EVERY_EDGE
  if (!lit) return;
#else
  if (lit && volume.every_triangle == 0u) return;
#endif

  vec4 end[3];
  for (int k = 0; k < 3; ++k)
    end[k] = frame.clip_from_world * end_of_shadow(world_position[k * stride]);
#ifdef WITH_CAPS
  // The cap keeps its first corner, so that turning it over does not change its depth.
  vec4 first = gl_in[0].gl_Position;
  vec4 second = gl_in[stride].gl_Position;
  vec4 third = gl_in[2 * stride].gl_Position;
  if (lit) {
    emit(first, second, third);
    emit(end[0], end[2], end[1]);
  } else {
    emit(first, third, second);
    emit(end[0], end[1], end[2]);
  }
#endif
  for (int k = 0; k < 3; ++k) {
    int start = k * stride;
    int stop = (k + 1) % 3 * stride;
    // Seen from the light, the edge runs the way that it is wound only where the triangle is lit.
    int p = lit ? start : stop;
    int q = lit ? stop : start;
#ifdef EVERY_EDGE
    bool silhouette = true;
#else
    // An open edge names one of its own corners as neighbour. A neighbour that continues the surface
    // as the light sees it has the edge from q to p.
    vec3 other = world_position[start + 1];
    bool silhouette = other == world_position[start] || other == world_position[stop] ||
                      !is_lit(world_position[q], world_position[p], other);
#endif
    if (silhouette) emit_side(p, q, end[p / stride], end[q / stride]);
  }
}
