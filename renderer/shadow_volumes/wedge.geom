// Penumbra wedge of every silhouette edge: a prism that holds all points from which the edge is seen
// before the light (van Sambeek 2007, fig. 3.8; Assarsson and Akenine-Moeller 2003). Six triangles:
// two faces of two along the edge, and one at each end. The far end is open at infinity; where it
// counts, because the camera may be inside or the wedge is cut off, two more close it.
#include "renderer/shadow_volumes/silhouette.glsl"

layout(triangle_strip, max_vertices = 72) out;
layout(location = 0) flat out vec3 edge_start;
layout(location = 1) flat out vec3 edge_end;

vec3 edge[2];
bool inside;  // the camera is, or may be: the faces on its other side are drawn, before all surfaces

void emit_corner(vec4 corner) {
  vec4 clip = frame.clip_from_world * corner;
  if (inside) clip.z = 0.9999 * clip.w;
  gl_Position = clip;
  edge_start = edge[0];
  edge_end = edge[1];
  EmitVertex();
}

void emit(vec4 a, vec4 b, vec4 c) {
  emit_corner(a);
  emit_corner(inside ? c : b);
  emit_corner(inside ? b : c);
  EndPrimitive();
}

void emit_quad(vec4 a, vec4 b, vec4 c, vec4 d) {
  emit(a, b, c);
  emit(a, c, d);
}

// Light that reaches around the edge on every side covers the whole picture.
void emit_screen() {
  const vec2 corners[4] = vec2[4](vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(1, 1));
  for (int i = 0; i < 4; ++i) {
    gl_Position = vec4(corners[i].x, mix(-1.0, 1.0, inside) * corners[i].y, 0.9999, 1.0);
    edge_start = edge[0];
    edge_end = edge[1];
    EmitVertex();
  }
  EndPrimitive();
}

// Distance from the camera within which the near plane may cut a wedge open.
float near_reach() {
  return 1.01 * frame.camera_direction.w * length((frame.world_from_clip * vec4(1.0, 1.0, 0.0, 1.0)).xyz);
}

vec4 far_end(vec3 from, vec3 along, bool clamped) {
  if (clamped) {
    float left = volume.end_plane.w - dot(from - light_origin(), volume.end_plane.xyz);
    return vec4(from + along * max(left / dot(along, volume.end_plane.xyz), 0.0), 1.0);
  }
  return endless_shadow(from, along, length(along));
}

void emit_wedge(vec3 start, vec3 end) {
  edge[0] = start;
  edge[1] = end;
  vec3 a = start;
  vec3 b = end;
  // Step 2 of the figure. Where the edge points at the light, both ends are one.
  level_with_light(a, b);
  float half_length = 0.5 * distance(a, b);
  vec3 middle = 0.5 * (a + b);
  vec3 from_light = vector_from_light(middle);
  float height = length(from_light);
  vec3 g = from_light / max(height, 1e-30);
  vec3 t = b - a;
  t -= g * dot(t, g);
  if (length(t) <= 1e-6 * height) t = abs(g.x) < 0.6 ? cross(g, vec3(1, 0, 0)) : cross(g, vec3(0, 1, 0));
  t = normalize(t);
  vec3 s = cross(t, g);

  bool is_parallel = frame.camera_position.w < 0.5;
  inside = is_parallel;
  float across, outwards;
  if (!tangents_past_edge(height, half_length, across, outwards)) {
    emit_screen();
    return;
  }
  vec3 camera = frame.camera_position.xyz - middle;
  float depth = dot(camera, g);
  float margin = near_reach();
  bool is_near = depth > -margin &&
                 abs(dot(camera, s)) < across * depth + margin * sqrt(1.0 + across * across) &&
                 abs(dot(camera, t)) < half_length + outwards * depth + margin * sqrt(1.0 + outwards * outwards);
  inside = is_near || is_parallel;

  vec3 along[4] = vec3[4](g - across * s - outwards * t, g + across * s - outwards * t,
                          g - across * s + outwards * t, g + across * s + outwards * t);
  bool clamped = has_end_plane();
  for (int i = 0; i < 4; ++i)
    clamped = clamped && dot(along[i], volume.end_plane.xyz) > 0.05 * length(along[i]);
  vec4 a_low = far_end(a, along[0], clamped);
  vec4 a_high = far_end(a, along[1], clamped);
  vec4 b_low = far_end(b, along[2], clamped);
  vec4 b_high = far_end(b, along[3], clamped);
  vec4 a_near = vec4(a, 1.0);
  vec4 b_near = vec4(b, 1.0);
  emit_quad(a_near, a_low, b_low, b_near);
  emit_quad(b_near, b_high, a_high, a_near);
  emit(b_near, b_low, b_high);
  emit(a_near, a_high, a_low);
  if (inside || clamped) emit_quad(a_low, a_high, b_high, b_low);
}

void main() {
  bool lit;
  if (!throws_volume(lit)) return;
  for (int k = 0; k < 3; ++k) {
    int p, q;
    if (is_silhouette(k, lit, p, q)) emit_wedge(world_position[p], world_position[q]);
  }
}
