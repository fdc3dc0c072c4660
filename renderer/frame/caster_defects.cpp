#include "renderer/frame/caster_defects.h"

#include <algorithm>
#include <set>

namespace penumbra {
namespace {

struct OpenCasters {
  std::set<std::uint32_t> instances;
};

}  // namespace

bool has_masked_casters(const GpuScene& scene) {
  return std::any_of(scene.ranges().begin(), scene.ranges().end(),
                     [](const DrawRange& range) { return range.masked && range.casts_shadow; });
}

std::size_t open_casters(const GpuScene& scene) {
  return scene
      .derived<OpenCasters>([&] {
        auto open = std::make_shared<OpenCasters>();
        for (const AdjacencyGroup& group :
             build_adjacency(scene.positions(), scene.indices(), scene.ranges()).groups)
          if (!group.closed && group.casts_shadow) open->instances.insert(group.instance);
        return open;
      })
      .instances.size();
}

}  // namespace penumbra
