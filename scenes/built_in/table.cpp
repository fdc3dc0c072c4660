#include "scenes/built_in/built_in.h"

namespace penumbra::scenes {

const std::vector<BuiltIn>& built_in_table() {
  static const std::vector<BuiltIn> table = {
      {"boxes", "Fifty boxes on a grey plane",
       "50 boxes on a grey plane, camera further away, one area light far above", make_boxes},
      {"half-plane", "Straight edge over a plane",
       "penumbra known in closed form: 1/3 m wide, linear, under a square light", make_half_plane},
      {"three-layers", "Three plates above each other",
       "overlapping occluders at three depths: shows light bleeding", make_three_layers},
      {"contact", "Objects that touch the ground",
       "shadows that must start where objects touch: shows what bias takes away", make_contact},
      {"leaky-box", "Closed room that must stay dark",
       "camera inside a closed thin-walled room under a bright light: shows leaks", make_leaky_box},
      {"camera-in-volume", "Camera inside a shadow volume",
       "camera in the shadow of a wall: shows miscounted volumes", make_camera_in_volume}};
  return table;
}

}  // namespace penumbra::scenes
