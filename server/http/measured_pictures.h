#pragma once

#include "server/http/frozen_study.h"
#include "server/jobs/render_service.h"
#include "study/measures.h"

namespace penumbra::server::http {

/// The known measures of a render, {name: number}; null where it was not measured. The reference's
/// are empty: its error is zero by definition and its time is no technique's.
nlohmann::json measures_of(const RenderRecord& record);

/// What was measured of the pictures on a version's ranked pages.
study::Measures measures_shown(const FrozenStudy& frozen,
                               const std::map<std::string, storage::FrozenPicture>& pictures);

}  // namespace penumbra::server::http
