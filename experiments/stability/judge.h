#pragma once

#include <cstdint>
#include <vector>

#include "renderer/render.h"
#include "renderer/scene/scene.h"

/// What a picture's shadows and light should be, by exact rays, and how far a drawn one is from it.
namespace penumbra::experiments::stability {

/// Picture of the scene's only light through its first camera, one sample in the middle of each
/// pixel.
struct Truth {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  /// Share of the light's points that are seen, or -1 where the pixel is not judged: no surface,
  /// one turned away, outside the cone, or a pixel that changes when its sample moves by 0.04
  /// pixels.
  std::vector<float> visible;
  /// Light that an unhidden surface of base colour 1 reflects beside the ambient: the cosine times
  /// the cone's and the light's strength. Of matte surfaces with flat facets.
  std::vector<double> light;
};

/// `points`: of the light's extent; 1 for a light without one. Throws std::logic_error for scenes
/// with other than one light.
Truth judge(const Scene& scene, std::uint32_t width, std::uint32_t height, std::uint32_t points);

/// Where a ray through a place of the picture starts, and where it goes. `across` is in pixels from
/// the left and the top.
struct ViewRay {
  glm::dvec3 from;
  glm::dvec3 along;  ///< perspective: at depth 1; otherwise unit
};
ViewRay view_ray(const Camera& camera, const glm::dvec2& across, std::uint32_t width,
                 std::uint32_t height);

struct Verdict {
  std::uint32_t judged = 0;    ///< pixels
  std::uint32_t shadowed = 0;  ///< of them with less than half of the light
  double visibility_rms = 0.0;
  double false_shadow = 0.0;    ///< light missing from what should be lit, in pixels
  double missing_shadow = 0.0;  ///< light where shadow should be, in pixels
  std::uint32_t lit = 0;        ///< pixels that see all of the light and reflect some of it
  std::uint32_t dark = 0;       ///< of them drawn with less than half of the light they reflect
  std::uint64_t non_finite = 0;

  double dark_share() const { return lit == 0 ? 0.0 : static_cast<double>(dark) / lit; }
};

/// `result` holds visibility and linear light of the same scene. Pixels that the renderer leaves
/// out as turned away from the light count as without light.
Verdict compare(const Truth& truth, const Scene& scene, const RenderResult& result);

}  // namespace penumbra::experiments::stability
