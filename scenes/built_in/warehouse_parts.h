#pragma once

#include "scenes/generators/scene_builder.h"

namespace penumbra::scenes {

/// Goods and furniture of the warehouse, each standing on y = 0.
Mesh make_rack(const Look& posts, const Look& boards);
Mesh make_slatted_crate(const Look& wood, double size);
Mesh make_pallet(const Look& wood);
Mesh make_barrel(const Look& paint);
Mesh make_hand_truck(const Look& metal, const Look& rubber);
Mesh make_lorry(const Look& cab, const Look& cargo, const Look& dark, const Look& rubber);

/// The building: 30 m by 18 m, eaves at 6 m, ridge at 8.4 m along x, doors towards +z and +x.
void add_hall(SceneBuilder& builder);

/// A travelling crane under the trusses with a crate on its hook.
void add_crane(SceneBuilder& builder);

/// Markings on the yard's asphalt, a kerb and trees around it.
void add_yard(SceneBuilder& builder);

/// What is stored in it.
void add_goods(SceneBuilder& builder);

}  // namespace penumbra::scenes
