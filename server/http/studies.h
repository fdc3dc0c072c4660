#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "server/http/frozen_study.h"
#include "server/http/routes.h"
#include "server/storage/participants.h"

namespace penumbra::server::http {

/// The version whose answers a call is about: `version` of the query, else the newest published.
std::shared_ptr<const FrozenStudy> published_at(Call& call);

/// One participant as researchers see it.
nlohmann::json participant_body(const FrozenStudy& frozen, const storage::ParticipantData& person,
                                const nlohmann::json& flags);

}  // namespace penumbra::server::http
