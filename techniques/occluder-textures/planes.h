#pragma once

#include "techniques/occluder-textures/picture.h"

namespace penumbra::techniques::occluder_textures {

/// A plane with its texture, in the renderer's world space.
struct OccluderPlane {
  Rectangle rectangle;
  Picture picture{1};
  Bounds receivers;  ///< shadows only surfaces within; everything where empty
};

struct PlaneOptions {
  std::uint32_t resolution = 256;  ///< texels along both sides of a texture
  std::uint32_t most_planes = 16;
  std::uint32_t extend = 4;  ///< texels that silhouettes are continued into bodies
};

struct PlaneSet {
  std::vector<OccluderPlane> planes;
  std::size_t bodies = 0;       ///< of all casters
  std::size_t represented = 0;  ///< of these, in at least one plane
};

/// Planes for the bodies of the scene's casters. A flat body is cut in half along its flat side; a
/// body with straight sides is cut near each of them; a round one is cut through the middle along
/// each of its axes. Planes of an instance that all but coincide become one. Those with the largest
/// silhouettes are kept.
PlaneSet generate_planes(const GpuScene& scene, const PlaneOptions& options);

/// The planes that the scene's author placed.
PlaneSet authored_planes(const GpuScene& scene, const PlaneOptions& options);

}  // namespace penumbra::techniques::occluder_textures
