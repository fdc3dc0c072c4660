// The cascade of the receiver's depth, as of plain cascades; where its view, which is fitted to a grid
// of samples, does not show a receiver between them, the first after it that does.
#define choose_views choose_by_depth
#include "renderer/shadow_maps/layouts/cascaded.glsl"
#undef choose_views

ViewChoice choose_views(vec3 position) {
  ViewChoice choice = choose_by_depth(position);
  if (choice.second >= 0 && choice.share > 0.0 && !is_on_view(choice.second, position)) choice.share = 0.0;
  if (is_on_view(choice.first, position)) return choice;
  for (int view = choice.first + 1; view < view_count(); ++view)
    if (is_on_view(view, position)) return ViewChoice(view, -1, 0.0);
  return choice;
}
