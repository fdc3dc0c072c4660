#pragma once

#include <nlohmann/json.hpp>

#include "server/http/frozen_study.h"
#include "server/http/routes.h"
#include "server/storage/participants.h"
#include "study/checks.h"

/// How far a person is in a study.
namespace penumbra::server::http {

/// Throws not_found for an unknown token, and counts it.
storage::ParticipantRecord person_at(Call& call);

/// Checks of a person whose answers are known.
study::PersonChecks checks_of(const FrozenStudy& frozen, const storage::ParticipantRecord& person,
                              const std::vector<storage::AnswerRecord>& answers);

/// How taking part ended: completed, screened_out, or empty.
std::string outcome_of(const FrozenStudy& frozen, const storage::ParticipantRecord& person,
                       const std::vector<storage::AnswerRecord>& answers);

/// Everything that the participant's page needs.
nlohmann::json enrolment_body(Service& service, const FrozenStudy& frozen,
                              const storage::ParticipantRecord& person);

}  // namespace penumbra::server::http
