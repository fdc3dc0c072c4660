#include "renderer/shadow_maps/texels/tiles.h"

namespace penumbra::shadow_maps {

Layout describe_iasm_gpu();
Layout describe_iasm_gpu() {
  return tile_layout("iasm-gpu",
                     "tiles as of iasm, ranked and drawn by the device without the host",
                     TileRanking::on_device);
}

}  // namespace penumbra::shadow_maps
