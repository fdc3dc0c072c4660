#pragma once

#include <string>

#include "renderer/scene/scene.h"

namespace penumbra::experiments {

/// From where a scene is seen and lit, beside how its file has it.
struct View {
  std::string camera;        ///< empty: the scene's first
  double camera_turn = 0.0;  ///< degrees about the vertical through what the camera looks at
  double light_turn = 0.0;  ///< degrees of all lights about the vertical through the scene's middle

  /// Names what differs from the scene's own view; empty where nothing does.
  std::string text() const;
};

/// The scene with that view's camera and lights turned.
Scene seen_from(const Scene& scene, const View& view);

}  // namespace penumbra::experiments
