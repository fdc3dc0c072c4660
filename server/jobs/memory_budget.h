#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "renderer/render.h"
#include "server/jobs/canonical_request.h"

namespace penumbra::server {

/// Memory that this process and its children may use, bytes: the machine's, or less where a control
/// group says so.
std::uint64_t usable_memory();

/// What each of so many workers may add to its address space, bytes: an even share of the usable
/// memory, less a reserve for the server and the system.
std::uint64_t worker_memory(unsigned workers);

/// Lets this process's address space grow by so many bytes and no further (RLIMIT_AS).
void limit_memory(std::uint64_t allowance);

/// The renderer's limits for a process that may add `allowance` bytes: a device that is the
/// processor has no memory of its own.
DeviceLimits limits_within(const Renderer& renderer, std::uint64_t allowance);

nlohmann::json limits_to_json(const DeviceLimits& limits);
/// Keys that are missing are limits that are not known.
DeviceLimits limits_from_json(const nlohmann::json& limits);

/// Throws `unsupported` where a device of these limits cannot hold what the request needs at least,
/// found without allocating any of it, or where its technique cannot serve it.
void check_fits(const CanonicalRequest& request, const std::set<std::string>& wants,
                const DeviceLimits& limits);

}  // namespace penumbra::server
