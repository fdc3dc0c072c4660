#include "renderer/plan/memory_check.h"

#include "renderer/error.h"

namespace penumbra {
namespace {

/// A limit of zero is not known.
void refuse_above(std::uint64_t limit, std::uint64_t wanted, const std::string& what,
                  const char* unit) {
  if (limit == 0 || wanted <= limit) return;
  throw unsupported(what + " takes " + std::to_string(wanted) + " " + unit + ", more than the " +
                    std::to_string(limit) + " that the device has for it");
}

/// Bytes of one light, each part checked.
std::uint64_t checked_light(const Requirements& needs, const DeviceLimits& limits) {
  std::uint64_t sum = 0;
  for (const MemoryNeed& need : needs.memory) {
    if (need.extent > 0)
      refuse_above(limits.image_extent, need.extent, "the " + need.name, "texels along an edge");
    else
      refuse_above(limits.storage_buffer, need.bytes, "the " + need.name, "bytes");
    sum += need.bytes;
  }
  refuse_above(limits.light, sum, "what the technique keeps for a light", "bytes");
  return sum;
}

}  // namespace

void check_memory(const std::vector<Requirements>& lights, const DeviceLimits& limits) {
  std::uint64_t sum = 0;
  for (const Requirements& needs : lights) sum += checked_light(needs, limits);
  refuse_above(limits.memory, sum, "what the technique keeps for all lights", "bytes");
}

void check_memory(const Plan& plan, const DeviceLimits& limits) {
  std::vector<Requirements> drawn;
  for (std::size_t i = 0; i < plan.needs.size(); ++i)
    if (plan.lights[i]) drawn.push_back(plan.needs[i]);
  check_memory(drawn, limits);
}

}  // namespace penumbra
