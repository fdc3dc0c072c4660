#pragma once

#include <nlohmann/json.hpp>

#include "study/measures.h"

namespace penumbra::study {

/// Each measure against mean ranks: Spearman and Kendall within every scene of `part` (a set of the
/// report), then pooled by ranks within scenes, so that scenes with larger errors count no more
/// than others; never by means over scenes. And by scene the Pareto front of frame time against
/// mean rank.
nlohmann::json objective_json(const nlohmann::json& part, const Measures& measures);

}  // namespace penumbra::study
