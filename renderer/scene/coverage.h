#pragma once

#include <map>

#include "renderer/scene/scene.h"

namespace penumbra {

/// What a primitive's alpha leaves of its triangles.
enum class Coverage {
  solid,   ///< all of them: no alpha mask, or an alpha that is nowhere below the cutoff
  holes,   ///< decided texel by texel
  nothing  ///< alpha is below the cutoff everywhere
};

/// Decides once where alpha is the same all over: comparing what was interpolated would tell equal
/// numbers apart.
class Coverages {
 public:
  explicit Coverages(const Scene& scene) : scene_(scene) {}

  Coverage of(const Mesh& mesh, const Primitive& primitive);

 private:
  /// Least and greatest alpha.
  struct Range {
    float low = 1.0f;
    float high = 1.0f;
  };

  static Range of_vertices(const Mesh& mesh, const Primitive& primitive);
  const Range& of_texture(int texture);

  const Scene& scene_;
  std::map<int, Range> textures_;
};

/// What interpolated alphas are compared with: a little less than the cutoff, so that an alpha that
/// equals it at all corners of a triangle is no hole.
float interpolated_cutoff(const Material& material);

}  // namespace penumbra
