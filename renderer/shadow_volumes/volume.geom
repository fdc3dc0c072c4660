// Shadow volume of a triangle with adjacency: caps at the triangle and at the shadow's end, and a side
// along every silhouette edge.
//
// Defined by the preamble: WITH_CAPS for counting on depth fail; CAPS_ONLY and SIDES_ONLY to draw the
// two apart; EDGES_ALONG to hand the edge of a side to the fragment stage.
#include "renderer/shadow_volumes/silhouette.glsl"

layout(triangle_strip, max_vertices = 24) out;

#ifdef EDGES_ALONG
layout(location = 0) flat out vec3 edge_start;
layout(location = 1) flat out vec3 edge_end;
vec3 edge[2];
#endif

void emit_corner(vec4 corner) {
  gl_Position = corner;
#ifdef EDGES_ALONG
  edge_start = edge[0];
  edge_end = edge[1];
#endif
  EmitVertex();
}

void emit(vec4 a, vec4 b, vec4 c) {
  emit_corner(a);
  emit_corner(b);
  emit_corner(c);
  EndPrimitive();
}

// Side that runs along p to q of a cap seen from the light. The same two triangles are emitted for
// q to p, each with two corners swapped: where sides of neighbouring volumes coincide, so do their
// depths, and they cancel in every pixel.
void emit_side(int p, int q, vec4 p_end, vec4 q_end) {
  vec4 p_clip = gl_in[p].gl_Position;
  vec4 q_clip = gl_in[q].gl_Position;
#ifdef EDGES_ALONG
  edge[0] = world_position[p];
  edge[1] = world_position[q];
#endif
  if (is_before(world_position[q], world_position[p])) {
    emit(q_clip, p_clip, p_end);
    emit(q_clip, p_end, q_end);
  } else {
    emit(p_clip, q_end, q_clip);
    emit(p_clip, p_end, q_end);
  }
}

void main() {
  bool lit;
  if (!throws_volume(lit)) return;
  vec4 end[3];
  for (int k = 0; k < 3; ++k)
    end[k] = frame.clip_from_world * end_of_shadow(world_position[k * stride]);
#ifdef WITH_CAPS
  // Caps of open meshes at their own triangles are drawn by open_cap.vert; of closed ones that are counted
  // with caps no lit triangle comes here. A cap keeps its first corner, so that turning it over does not
  // change its depth.
  bool is_closed = volume.every_triangle == 0u;
  if (!lit && is_closed)
    emit(gl_in[0].gl_Position, gl_in[2 * stride].gl_Position, gl_in[stride].gl_Position);
  if (lit)
    emit(end[0], end[2], end[1]);
  else
    emit(end[0], end[1], end[2]);
#endif
#ifndef CAPS_ONLY
  for (int k = 0; k < 3; ++k) {
    int p, q;
    if (is_silhouette(k, lit, p, q)) emit_side(p, q, end[p / stride], end[q / stride]);
  }
#endif
}
