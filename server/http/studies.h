#pragma once

#include <memory>

#include "server/http/frozen_study.h"
#include "server/http/routes.h"

namespace penumbra::server::http {

/// The version whose answers a call is about: `version` of the query, otherwise the newest
/// published.
std::shared_ptr<const FrozenStudy> published_at(Call& call);

}  // namespace penumbra::server::http
