// Corners of one triangle that covers the target, at depth 0: infinity.
vec4 full_screen_corner() {
  vec2 corner = vec2(gl_VertexIndex << 1 & 2, gl_VertexIndex & 2);
  return vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
