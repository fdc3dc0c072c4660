#pragma once

#include <nlohmann/json.hpp>

namespace penumbra::study {

/// Checks a document against the study schema. Throws bad_value whose field is the path of the
/// innermost fault, e.g. `pages[2].reference`; keys that the schema does not know are faults.
void check_study_schema(const nlohmann::json& document);

}  // namespace penumbra::study
