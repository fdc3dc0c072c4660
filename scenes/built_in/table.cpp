#include "scenes/built_in/built_in.h"

namespace penumbra::scenes {

const std::vector<BuiltIn>& built_in_table() {
  static const std::vector<BuiltIn> table = {
      {"car", "A car on a box", "a car on a box, two area lights close above it", make_car},
      {"boxes", "Fifty boxes on a grey plane",
       "50 boxes on a grey plane, camera further away, one area light far above", make_boxes},
      {"disco-box", "A box under red, green and blue lights",
       "one box, three close area lights red, green and blue", make_disco_box},
      {"island", "An island in the sea",
       "an island in the sea, one light so far away that penumbrae vanish", make_island},
      {"warehouse-inside", "A warehouse from inside",
       "hall with shelves, crates, beams and skylights, one near area light",
       make_warehouse_inside},
      {"warehouse-outside", "A warehouse from outside",
       "the same hall from outside, camera and light far away and close to each other",
       make_warehouse_outside},
      {"half-plane", "Straight edge over a plane",
       "penumbra known in closed form: 1/3 m wide, linear, under a square light", make_half_plane},
      {"three-layers", "Three plates above each other",
       "overlapping occluders at three depths: shows light bleeding", make_three_layers},
      {"contact", "Objects that touch the ground",
       "shadows that must start where objects touch: shows what bias takes away", make_contact},
      {"leaky-box", "Closed room that must stay dark",
       "camera inside a closed thin-walled room under a bright light: shows leaks", make_leaky_box},
      {"camera-in-volume", "Camera inside a shadow volume",
       "camera in the shadow of a wall: shows miscounted volumes", make_camera_in_volume},
      {"aircraft", "A jet on an apron",
       "a model of flat parts that shadow each other: what occluder textures are good at",
       make_aircraft},
      {"teapot", "A teapot on a table",
       "a model of round parts that shadow each other: what occluder textures are bad at",
       make_teapot},
      {"trees", "Trees on a meadow",
       "60 copies of one tree, near and far: casters that a part of a map can leave out",
       make_trees},
      {"village", "Two houses around a yard",
       "two houses and their yard as one mesh: nothing of it can be left out of any map",
       make_village},
      {"tower", "A lattice tower",
       "iron lattice of about 10,800 triangles: thin casters in front "
       "of thin casters",
       make_tower},
      {"water-tower", "A water tower at night",
       "a tank on legs under one spot lamp: map size against the width of its cone",
       make_water_tower},
      {"town", "A town of a million triangles",
       "streets of houses, gardens and a church, near and far: what scale costs", make_town}};
  return table;
}

}  // namespace penumbra::scenes
