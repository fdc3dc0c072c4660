#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "experiments/engine/engine.h"

namespace penumbra::experiments::recommend {

/// Visibility may be off by this much more, as a share of the pick's error and at least by so much.
inline constexpr double granted_share = 0.05;
inline constexpr double granted_least = 0.002;

/// What the scene does not need of the run, each measured: smaller maps, one halving after the
/// other while the error stays within what is granted; each soft light drawn hard; and casters that
/// the plan leaves out already. A list of {"what", "why", "frame_ms", "saved_ms", "saved_bytes",
/// "error", "worth_it", "taken"}: error is visibility_rms; taken says that every render does so.
nlohmann::json savings(Engine& engine, const Run& pick,
                       const std::function<nlohmann::json(const Run&)>& measure);

}  // namespace penumbra::experiments::recommend
