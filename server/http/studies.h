#pragma once

#include <memory>

#include "server/http/frozen_study.h"
#include "server/http/routes.h"
#include "server/http/study_export.h"

namespace penumbra::server::http {

/// The version whose answers a call is about: `version` of the query, otherwise the newest
/// published.
std::shared_ptr<const FrozenStudy> published_at(Call& call);

/// The answers to a published version, with what was measured of its pictures.
StudyExport export_of(Service& service, std::shared_ptr<const FrozenStudy> frozen);

}  // namespace penumbra::server::http
