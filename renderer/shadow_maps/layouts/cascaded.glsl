// The cascade of the receiver's depth before the camera, and the next one over the end of that.
ViewChoice choose_views(vec3 position) {
  float depth = dot(position - frame.camera_position.xyz, frame.camera_direction.xyz);
  int last = view_count() - 1;
  int view = 0;
  while (view < last && depth > map_view(view).choice.y) ++view;
  if (view == last) return ViewChoice(view, -1, 0.0);
  vec4 choice = map_view(view).choice;  // x where the next one begins, y where this one ends, m
  float share = clamp((depth - choice.x) / max(choice.y - choice.x, 1e-30), 0.0, 1.0);
  return ViewChoice(view, view + 1, depth > choice.x ? share : 0.0);
}
