#pragma once

#include "renderer/plan/plan.h"
#include "renderer/render.h"

namespace penumbra {

/// Throws `unsupported`, naming what is too large, where a device cannot hold what the technique
/// allocates for the lights that `plan` draws. Called before anything is allocated: drivers accept
/// what they cannot hold.
void check_memory(const Plan& plan, const DeviceLimits& limits);

/// The same without a plan, for all lights of a request; one that fails may yet have lights that
/// reach nothing, which only its plan tells.
void check_memory(const std::vector<Requirements>& lights, const DeviceLimits& limits);

}  // namespace penumbra
