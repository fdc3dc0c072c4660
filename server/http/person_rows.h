#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "server/http/frozen_study.h"
#include "server/storage/participants.h"
#include "study/checks.h"
#include "study/export_tables.h"
#include "study/responses.h"

/// One person as tables and documents of an export have them.
namespace penumbra::server::http {

/// Rows of one person by page.
using Pages = std::vector<std::vector<study::ResponseRow>>;

/// In the order of the pages: of the answers that count, or of those that were replaced.
Pages pages_of(const FrozenStudy& frozen, const storage::ParticipantData& person,
               const std::vector<storage::AnswerRecord>& answers);

/// A person as responses.json has it.
nlohmann::json person_json(const FrozenStudy& frozen, const storage::ParticipantData& person);

/// A row of participants.csv.
study::ParticipantRow participant_row(const FrozenStudy& frozen,
                                      const storage::ParticipantData& person,
                                      const study::PersonChecks& checks, const std::string& flags);

/// Checks of a person, with how often the same name entered the study.
study::PersonChecks checks_of(const FrozenStudy& frozen, const storage::ParticipantData& person,
                              const std::map<std::string, int>& entries);

}  // namespace penumbra::server::http
