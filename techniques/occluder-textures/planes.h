#pragma once

#include "techniques/occluder-textures/picture.h"

namespace penumbra::techniques::occluder_textures {

/// A plane in the renderer's world space.
struct OccluderPlane {
  Rectangle rectangle;
  std::size_t texture = 0;  ///< of PlaneSet::textures
  Bounds receivers;         ///< shadows only surfaces within; everything where empty
  double margin = 0.0;      ///< m: shadows nothing nearer to the plane, which is the caster itself
};

struct PlaneOptions {
  std::uint32_t resolution = 256;  ///< texels along both sides of a texture
  std::uint32_t most_planes = 16;  ///< of one model
  std::uint32_t extend = 4;        ///< texels that silhouettes are continued into bodies
};

/// Planes that shadow only what their common box stands before: those of one caster.
struct PlaneGroup {
  std::vector<OccluderPlane> planes;
  Bounds box() const;
};

struct PlaneSet {
  std::vector<Picture> textures;
  std::vector<PlaneGroup> groups;
  std::size_t bodies = 0;       ///< of all casters
  std::size_t represented = 0;  ///< of these, in at least one plane
  std::size_t open = 0;         ///< of these, sheets that are not flat, cut as if they were closed

  std::size_t planes() const;
};

/// Planes for the bodies of the scene's casters, a group for each instance. Instances of a mesh
/// that differ by turning, moving and scaling are one model and share its textures. Sheets are
/// taken apart into flat parts, whose planes are their own. A flat body is cut in half along its
/// flat side; a body with straight sides is cut near each of them; a round one is cut through the
/// middle along each of its axes. Planes of a model that all but coincide become one. Those with
/// the largest silhouettes are kept, `most_planes` for each model, and as many of all as memory
/// allows.
PlaneSet generate_planes(const GpuScene& scene, const PlaneOptions& options);

/// Puts groups that lie near each other next to each other (Morton's order of their middles).
void sort_by_place(std::vector<PlaneGroup>& groups);

/// The planes that the scene's author placed.
PlaneSet authored_planes(const GpuScene& scene, const PlaneOptions& options);

}  // namespace penumbra::techniques::occluder_textures
