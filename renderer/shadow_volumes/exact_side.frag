// Counts a side of a volume where the view ray crosses it behind the visible surface: where camera and
// surface lie on the same side of its plane. The rasteriser's depths would do, but for surfaces that
// the plane all but touches: there penumbra wedges must decide the same (wedge.frag).
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_volumes/deep_count.glsl"
#include "renderer/shadow_volumes/light_side.glsl"

layout(location = 0) flat in vec3 edge_start;
layout(location = 1) flat in vec3 edge_end;

uniform sampler2D geometry_position;

void main() {
  vec4 surface = texel_of(geometry_position, ivec2(gl_FragCoord.xy));
  EdgePlane plane = plane_of_edge(edge_start, edge_end);
  bool has_perspective = frame.camera_position.w > 0.5;
  float camera = mix(-dot(plane.normal, frame.camera_direction.xyz),
                     side_of_plane(plane, frame.camera_position.xyz), has_perspective);
  if (surface.w == 0.0 || (side_of_plane(plane, surface.xyz) < 0.0) != (camera < 0.0)) discard;
  count_step();
}
