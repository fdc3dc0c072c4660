#include "renderer/scene/coverage.h"

#include <algorithm>

namespace penumbra {

Coverages::Range Coverages::of_vertices(const Mesh& mesh, const Primitive& primitive) {
  if (mesh.colors.empty() || primitive.index_count == 0) return {};
  const auto alpha = [&](std::uint32_t i) {
    return mesh.colors[mesh.indices[primitive.first_index + i]].a;
  };
  Range range{alpha(0), alpha(0)};
  for (std::uint32_t i = 1; i < primitive.index_count; ++i) {
    range.low = std::min(range.low, alpha(i));
    range.high = std::max(range.high, alpha(i));
  }
  return range;
}

const Coverages::Range& Coverages::of_texture(int texture) {
  const auto [entry, added] = textures_.try_emplace(texture);
  if (!added || texture < 0) return entry->second;
  std::uint8_t low = 255, high = 0;
  const auto& rgba = scene_.textures[static_cast<std::size_t>(texture)].rgba;
  for (std::size_t i = 3; i < rgba.size(); i += 4) {
    low = std::min(low, rgba[i]);
    high = std::max(high, rgba[i]);
  }
  entry->second = {static_cast<float>(low) / 255.0f, static_cast<float>(high) / 255.0f};
  return entry->second;
}

Coverage Coverages::of(const Mesh& mesh, const Primitive& primitive) {
  const Material& material = scene_.materials[primitive.material];
  if (material.alpha_mode != AlphaMode::mask) return Coverage::solid;
  const Range vertices = of_vertices(mesh, primitive);
  const Range& texels = of_texture(material.texture);
  const float low = material.alpha * vertices.low * texels.low;
  const float high = material.alpha * vertices.high * texels.high;
  if (low >= material.alpha_cutoff) return Coverage::solid;
  return high < material.alpha_cutoff ? Coverage::nothing : Coverage::holes;
}

float interpolated_cutoff(const Material& material) {
  return material.alpha_cutoff * (1.0f - 1e-6f);
}

}  // namespace penumbra
