#include "server/http/person_rows.h"

#include "server/http/person_state.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

json answer_json(const storage::AnswerRecord& answer) {
  return {{"answered_at", answer.answered_at}, {"body", answer.body}};
}

}  // namespace

Pages pages_of(const FrozenStudy& frozen, const storage::ParticipantData& person,
               const std::vector<storage::AnswerRecord>& answers) {
  std::map<int, int> before;
  const bool current = &answers == &person.answers;
  if (current)
    for (const auto& earlier : person.replaced) ++before[earlier.page];
  Pages pages;
  const auto plan = frozen.plan(person.participant.place);
  const auto& arm = study::arm_of(frozen.study, plan);
  for (const auto& stored : answers) {
    const auto& planned = plan.pages.at(static_cast<std::size_t>(stored.page));
    const int answers_before = current ? before[stored.page] : before[stored.page]++;
    if (planned.kind == study::PageKind::practice ||
        !study::page_of(frozen.study, planned).counted())
      continue;
    const auto answer = study::parse_answer(stored.body, arm, planned.slots.size());
    pages.push_back(study::response_rows(frozen.study, frozen.hash, person.participant.pseudonym,
                                         arm, planned, stored.page, answer, stored.answered_at));
    auto facts = std::make_shared<study::PageFacts>();
    facts->seen = answer.observations;
    facts->participant_completed = !person.participant.completed_at.empty();
    facts->answers_before = answers_before;
    for (auto& row : pages.back()) {
      row.included = !person.excluded();
      row.started_at = person.participant.entered_at;
      row.page = facts;
    }
  }
  return pages;
}

json person_json(const FrozenStudy& frozen, const storage::ParticipantData& person) {
  const auto& who = person.participant;
  const auto plan = frozen.plan(who.place);
  json pages = json::array();
  for (const auto& stored : person.answers) {
    const auto& planned = plan.pages.at(static_cast<std::size_t>(stored.page));
    const auto& page = study::page_of(frozen.study, planned);
    json pictures = json::array();
    for (const std::size_t number : planned.slots) pictures.push_back(page.pictures.at(number).id);
    json earlier = json::array();
    for (const auto& replaced : person.replaced)
      if (replaced.page == stored.page) earlier.push_back(answer_json(replaced));
    pages.push_back({{"page_index", stored.page},
                     {"kind", study::kind_name(planned.kind)},
                     {"page", page.id},
                     {"scene", page.scene},
                     {"pictures_by_slot", pictures},
                     {"answer", answer_json(stored)},
                     {"earlier_answers", earlier}});
  }
  json decisions = json::array();
  for (const auto& decision : person.exclusions)
    decisions.push_back({{"excluded", decision.excluded},
                         {"reason", decision.reason},
                         {"at", decision.decided_at}});
  return {{"participant", who.pseudonym},
          {"arm", study::arm_of(frozen.study, plan).id},
          {"entered_at", who.entered_at},
          {"completed_at", who.completed_at.empty() ? json(nullptr) : json(who.completed_at)},
          {"language", who.language},
          {"consent_version", who.consent_version},
          {"parameters", who.parameters},
          {"details", who.details},
          {"decisions", decisions},
          {"pages", pages}};
}

study::ParticipantRow participant_row(const FrozenStudy& frozen,
                                      const storage::ParticipantData& person,
                                      const study::PersonChecks& checks, const std::string& flags) {
  const auto& who = person.participant;
  const auto outcome = outcome_of(frozen, who, person.answers);
  const auto plan = frozen.plan(who.place);
  return {who.pseudonym,
          who.place,
          study::arm_of(frozen.study, plan).id,
          who.entered_at,
          who.seen_at,
          who.completed_at,
          outcome.empty() ? "started" : outcome,
          person.answers.size(),
          plan.pages.size(),
          who.language,
          who.consent_version,
          who.test,
          person.excluded(),
          person.excluded() ? person.exclusions.back().reason : "",
          flags,
          checks,
          who.parameters,
          who.details};
}

study::PersonChecks checks_of(const FrozenStudy& frozen, const storage::ParticipantData& person,
                              const std::map<std::string, int>& entries) {
  auto checks = checks_of(frozen, person.participant, person.answers);
  const auto found = entries.find(person.participant.person_id);
  if (found != entries.end()) checks.entries = found->second;
  return checks;
}

}  // namespace penumbra::server::http
