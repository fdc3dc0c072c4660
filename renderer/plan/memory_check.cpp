#include "renderer/plan/memory_check.h"

#include <algorithm>

#include "renderer/error.h"

namespace penumbra {
namespace {

/// A limit of zero is not known.
void refuse_above(std::uint64_t limit, std::uint64_t wanted, const std::string& what,
                  const char* unit, const std::string& parameter) {
  if (limit == 0 || wanted <= limit) return;
  throw unsupported(what + " takes " + std::to_string(wanted) + " " + unit + ", more than the " +
                        std::to_string(limit) + " that the device has for it",
                    parameter);
}

/// The parameter that sets the size of the largest part; empty where nothing is kept.
std::string decisive_parameter(const Requirements& needs) {
  const auto largest =
      std::max_element(needs.memory.begin(), needs.memory.end(),
                       [](const auto& a, const auto& b) { return a.bytes < b.bytes; });
  return largest == needs.memory.end() ? "" : largest->parameter;
}

/// Bytes of one light, each part checked.
std::uint64_t checked_light(const Requirements& needs, const DeviceLimits& limits) {
  std::uint64_t sum = 0;
  for (const MemoryNeed& need : needs.memory) {
    if (need.extent > 0)
      refuse_above(limits.image_extent, need.extent, "the " + need.name, "texels along an edge",
                   need.parameter);
    else
      refuse_above(limits.storage_buffer, need.bytes, "the " + need.name, "bytes", need.parameter);
    sum += need.bytes;
  }
  refuse_above(limits.light, sum, "what the technique keeps for a light", "bytes",
               decisive_parameter(needs));
  return sum;
}

}  // namespace

void check_memory(const std::vector<Requirements>& lights, const DeviceLimits& limits) {
  std::uint64_t sum = 0;
  for (const Requirements& needs : lights) sum += checked_light(needs, limits);
  refuse_above(limits.memory, sum, "what the technique keeps for all lights", "bytes",
               lights.empty() ? "" : decisive_parameter(lights.front()));
}

void check_memory(const Plan& plan, const DeviceLimits& limits) {
  std::vector<Requirements> drawn;
  for (std::size_t i = 0; i < plan.needs.size(); ++i)
    if (plan.lights[i]) drawn.push_back(plan.needs[i]);
  check_memory(drawn, limits);
}

}  // namespace penumbra
