#include "renderer/shadow_maps/texels/tiles.h"

namespace penumbra::shadow_maps {

Layout describe_iasm_delayed();
Layout describe_iasm_delayed() {
  return tile_layout(
      "iasm-delayed",
      "tiles as of iasm, ranked by what the last frame saw, so that the host does not wait",
      TileRanking::previous_frame);
}

}  // namespace penumbra::shadow_maps
