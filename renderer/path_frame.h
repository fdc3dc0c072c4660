#pragma once

#include <glm/glm.hpp>

#include "renderer/image.h"

namespace penumbra {

/// What a frame of a camera's path shows, and where.
struct PathFrame {
  ImageF points;        ///< of one sample of each pixel: xyz, m, as `clip_from_world` counts them,
                        ///< and 0 on background, above 0 on a surface
  double sample = 0.5;  ///< where in its pixel that sample is, along both axes, 0..1
  ImageF visibility;    ///< a channel per light, 1 lit
  ImageF judged;        ///< a channel per light, as RenderResult has it
  glm::dmat4 clip_from_world;  ///< of the whole picture
};

}  // namespace penumbra
