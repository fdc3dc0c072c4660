#pragma once

#include "renderer/scene/scene.h"

/// Small, hard scenes that are pushed to extremes: one matte material, flat facets, one light, one
/// camera. All are askew, since planes along the axes hide what normals and slopes lose.
namespace penumbra::experiments::stability {

/// What a subject scene is made of, in metres; each axis changes one of these.
struct SubjectShape {
  double ground = 6.0;        ///< half of the slab's side
  double gap = 0.3;           ///< under the crate
  double thickness = 1.0;     ///< of the crate, upwards
  double post = 0.06;         ///< width of the upright post
  double squash = 1.0;        ///< factor of the crate's breadth, in its instance's matrix
  bool mirrored = false;      ///< the crate's matrix turns its triangles inside out
  std::uint32_t copies = 1;   ///< crates in one place
  std::uint32_t slivers = 0;  ///< triangles of a disc that is nothing but slivers; 0: none
  double outlier = 0.0;       ///< distance of one more crate, behind the camera; 0: none
};

/// A crate, a ball of 320 facets and a post over a slab, under a spot 7 m away.
Scene subject(const SubjectShape& shape = {});

/// A point of the ground in the middle of a straight border of the crate's shadow, upright.
glm::dvec3 shadow_border();

/// `count` thin plates over each other above a slab, `thickness` metres each, under the same spot.
Scene stack(std::uint32_t count, double thickness);

/// Changes of lights and cameras are written upright, and the scene turned askew afterwards.
Scene askew(Scene upright);

/// `factor` (about the origin) first, then a turn about a skew axis, then the offset. What is drawn
/// stays the same.
Scene moved(Scene scene, double factor, double degrees, const glm::dvec3& offset);

/// Ways in which a crate may be broken, by name, and the crate so broken in the subject scene.
enum class Defect {
  none,
  doubled_triangles,
  empty_triangles,
  t_junctions,
  inside_out,
  face_turned,
  face_missing
};
Scene broken_subject(Defect defect);

}  // namespace penumbra::experiments::stability
