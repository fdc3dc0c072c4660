#pragma once

#include "scenes/generators/scene_builder.h"

namespace penumbra::scenes {

/// A photographer's studio: a floor that bends up into the wall behind (towards -z), as one closed
/// sheet, with the planar receiver on its flat part. The floor reaches `depth` to the front and as
/// far as the bend begins, `back`, to the rear. Metres.
void add_studio(SceneBuilder& builder, const Look& look, double half_width, double back,
                double front, double bend_radius, double wall_height = 6.0);

}  // namespace penumbra::scenes
