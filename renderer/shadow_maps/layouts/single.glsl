// One view, or the one of six around the light that looks at the receiver.
int facing_view(vec3 offset) {
  if (view_count() == 1) return 0;
  vec3 size = abs(offset);
  if (size.x >= size.y && size.x >= size.z) return offset.x > 0.0 ? 0 : 1;
  if (size.y >= size.z) return offset.y > 0.0 ? 2 : 3;
  return offset.z > 0.0 ? 4 : 5;
}

ViewChoice choose_views(vec3 position) {
  int view = facing_view(position - map_view(0).origin.xyz);
  return ViewChoice(is_on_view(view, position) ? view : -1, -1, 0.0);
}
