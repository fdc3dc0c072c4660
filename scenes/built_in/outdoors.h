#pragma once

#include "scenes/generators/scene_builder.h"

namespace penumbra::scenes {

/// Broad-leaved tree, about 6 m high, its trunk's foot at y = 0.
Mesh make_tree(const Look& bark, const Look& leaves, std::uint32_t seed);

struct HouseLooks {
  Look wall, roof, timber, glass;
};

/// A house of `storeys` of 2.8 m under a gable roof whose ridge runs along x, its door towards +z,
/// centred on the origin. `width` and `depth` are those of its walls, metres; `pitch` is the roof's
/// rise over half the depth.
struct HouseForm {
  double width = 9.0, depth = 7.0;
  int storeys = 2;
  double pitch = 0.9;
  bool chimney = true;
  bool fine = false;  ///< windows have frames of four panes, a few thousand triangles more
};

void add_house(Mesh& mesh, const HouseForm& form, const HouseLooks& looks,
               const glm::dmat4& place = glm::dmat4(1.0));

/// A wooden fence of posts and two rails between two points on the ground.
void add_fence(Mesh& mesh, const glm::dvec3& from, const glm::dvec3& to, const Look& wood);

/// Blue sky and the light that it gives.
void add_sky(Scene& scene);

}  // namespace penumbra::scenes
