#include "renderer/shadow_maps/texels/tiles.h"

namespace penumbra::shadow_maps {

Layout describe_iasm();
Layout describe_iasm() {
  return tile_layout("iasm",
                     "4 x 4 tiles in one buffer, finer where more and nearer pixels are seen, for "
                     "directional lights",
                     TileRanking::read_back);
}

}  // namespace penumbra::shadow_maps
