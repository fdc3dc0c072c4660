#pragma once

#include <cstdint>
#include <set>

#include "renderer/frame/gpu_scene.h"
#include "renderer/scene/light_points.h"

namespace penumbra::shadow_volumes {

/// Which triangles of casters throw a volume each.
struct VolumeTriangles {
  /// Those that look at the light; otherwise those that look away from it.
  bool lit = false;
  /// Instances of which all do.
  std::set<std::uint32_t> sheets;
};

/// False only if no ray from the light's centre meets more than `most` triangles that throw
/// volumes, so that no point lies in more than `most` volumes. Cuts the directions into ever
/// smaller cells until none holds more triangles; true where that takes too long.
bool may_crowd(const GpuScene& scene, const WorldLight& light, const VolumeTriangles& triangles,
               std::size_t most);

/// True only if some ray from the light's centre meets more than `most` of these triangles; false
/// where finding one takes too long.
bool surely_crowds(const GpuScene& scene, const WorldLight& light, const VolumeTriangles& triangles,
                   std::size_t most);

}  // namespace penumbra::shadow_volumes
