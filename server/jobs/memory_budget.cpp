#include "server/jobs/memory_budget.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "renderer/error.h"
#include "renderer/plan/memory_check.h"
#include "renderer/technique.h"
#include "server/jobs/task.h"

namespace penumbra::server {
namespace {

using nlohmann::json;

constexpr std::uint64_t gib = std::uint64_t{1} << 30;
constexpr std::uint64_t least_worker = gib;       ///< below this hardly a study's picture is drawn
constexpr std::uint64_t least_reserve = gib / 2;  ///< server, database, caches of the system
constexpr std::uint64_t reserve_share = 8;        ///< or one part in so many of the whole

/// Limit of this process's control group (version 2), or the largest number.
std::uint64_t control_group_limit() {
  std::ifstream groups("/proc/self/cgroup");
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (std::string line; std::getline(groups, line);) {
    if (!line.starts_with("0::")) continue;
    // Every group above limits this one as well.
    for (std::filesystem::path place = line.substr(3);; place = place.parent_path()) {
      std::uint64_t limit = 0;
      std::ifstream file("/sys/fs/cgroup" + place.string() + "/memory.max");
      if (file >> limit) least = std::min(least, limit);
      if (!place.has_relative_path()) break;
    }
  }
  return least;
}

/// Bytes per pixel of what a picture's parts take in the worker, at least.
std::uint64_t pixel_bytes(const CanonicalRequest& request, const std::set<std::string>& wants) {
  std::uint64_t bytes = 4;
  if (wants.contains(want::linear)) bytes += 4 * sizeof(float);
  // Visibility, and where it is judged.
  if (wants.contains(want::visibility) || wants.contains(want::quality))
    bytes += 2 * sizeof(float) * request.scene->lights.size();
  return bytes;
}

}  // namespace

std::uint64_t usable_memory() {
  const std::uint64_t machine = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) *
                                static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES));
  return std::min(machine, control_group_limit());
}

std::uint64_t worker_memory(unsigned workers) {
  const std::uint64_t all = usable_memory();
  const std::uint64_t reserve = std::max(least_reserve, all / reserve_share);
  return std::max(least_worker, (all - std::min(all, reserve)) / std::max(1u, workers));
}

void limit_memory(std::uint64_t allowance) {
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlimit limit{pages * page + allowance, pages * page + allowance};
  if (::setrlimit(RLIMIT_AS, &limit) != 0)
    throw std::system_error(errno, std::generic_category(), "limiting a process's memory");
}

DeviceLimits limits_within(const Renderer& renderer, std::uint64_t allowance) {
  DeviceLimits limits = renderer.limits();
  if (renderer.device().type == "cpu") limits.memory = std::min(limits.memory, allowance);
  return limits;
}

json limits_to_json(const DeviceLimits& limits) {
  return {{"memory", limits.memory},
          {"light", limits.light},
          {"storage_buffer", limits.storage_buffer},
          {"image_extent", limits.image_extent}};
}

DeviceLimits limits_from_json(const json& limits) {
  return {limits.value("memory", std::uint64_t{0}), limits.value("light", std::uint64_t{0}),
          limits.value("storage_buffer", std::uint64_t{0}), limits.value("image_extent", 0u)};
}

void check_fits(const CanonicalRequest& canonical, const std::set<std::string>& wants,
                const DeviceLimits& limits) {
  const std::uint64_t picture = canonical.request.at("width").get<std::uint64_t>() *
                                canonical.request.at("height").get<std::uint64_t>() *
                                pixel_bytes(canonical, wants);
  if (limits.memory > 0 && picture > limits.memory)
    throw unsupported("a picture of this size takes " + std::to_string(picture) +
                          " bytes, more than the " + std::to_string(limits.memory) +
                          " that a worker may have",
                      "width");
  const RenderRequest request = to_render_request(canonical);
  const ParameterValues parameters =
      complete_parameters(request.technique->parameters, request.parameters);
  const std::vector<Bounds> boxes = instance_boxes(*request.scene);
  try {
    check_memory(requirements_of(request, parameters, boxes), limits);
  } catch (const Error&) {
    // Lights that reach nothing are not drawn; only the plan knows them, and takes longer.
    check_memory(make_plan(request, parameters, boxes), limits);
  }
}

}  // namespace penumbra::server
