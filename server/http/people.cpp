// Participants as researchers see them, and decisions about them.
#include <algorithm>
#include <functional>

#include "server/http/body.h"
#include "server/http/clock.h"
#include "server/http/person_state.h"
#include "server/http/reply.h"
#include "server/http/service.h"
#include "server/http/studies.h"
#include "server/http/study_export.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

json decisions_body(const storage::ParticipantData& person) {
  auto history = json::array();
  for (const auto& decision : person.exclusions)
    history.push_back({{"excluded", decision.excluded},
                       {"reason", decision.reason},
                       {"at", decision.decided_at}});
  return history;
}

/// What happened when: entry, answers, the end.
json timeline_body(const FrozenStudy& frozen, const storage::ParticipantData& person) {
  const auto plan = frozen.plan(person.participant.place);
  auto list = json::array();
  const auto add = [&](const storage::AnswerRecord& answer, bool current) {
    const auto& planned = plan.pages.at(static_cast<std::size_t>(answer.page));
    list.push_back({{"at", answer.answered_at},
                    {"page_index", answer.page},
                    {"page", study::page_of(frozen.study, planned).id},
                    {"kind", study::kind_name(planned.kind)},
                    {"current", current},
                    {"active_ms", answer.body.value("active_ms", json())},
                    {"difficulty", answer.body.value("difficulty", json())},
                    {"swaps", answer.body.value("swaps", 0)},
                    {"blurs", answer.body.value("blurs", 0)}});
  };
  for (const auto& answer : person.replaced) add(answer, false);
  for (const auto& answer : person.answers) add(answer, true);
  std::stable_sort(list.begin(), list.end(),
                   [](const json& a, const json& b) { return a.at("at") < b.at("at"); });
  return list;
}

json participant_body(const FrozenStudy& frozen, const storage::ParticipantData& person,
                      const json& flags) {
  const auto& who = person.participant;
  const auto outcome = outcome_of(frozen, who, person.answers);
  const auto plan = frozen.plan(who.place);
  return {{"participant", who.pseudonym},
          {"arm", study::arm_of(frozen.study, plan).id},
          {"entered_at", who.entered_at},
          {"last_seen_at", who.seen_at},
          {"completed_at", who.completed_at.empty() ? json(nullptr) : json(who.completed_at)},
          {"outcome", outcome.empty() ? "started" : outcome},
          {"answered", person.answers.size()},
          {"pages", plan.pages.size()},
          {"language", who.language},
          {"test", who.test},
          {"excluded", person.excluded()},
          {"exclusion_reason", person.excluded() ? person.exclusions.back().reason : ""},
          {"flags", flags},
          {"history", decisions_body(person)},
          {"timeline", timeline_body(frozen, person)}};
}

/// Participants of the version for which `wanted` holds.
json bodies_of(Call& call, const std::function<bool(const storage::ParticipantData&)>& wanted) {
  const auto frozen = published_at(call);
  StudyExport exported(call.service.participants, frozen);
  const auto& flags = exported.flags_by_participant();
  auto list = json::array();
  call.service.participants.each(
      frozen->study.id, frozen->version, [&](const storage::ParticipantData& person) {
        if (!wanted(person)) return;
        const auto found = flags.find(person.participant.pseudonym);
        list.push_back(participant_body(*frozen, person,
                                        found == flags.end() ? json::array() : found->second));
      });
  return list;
}

void list_participants(Call& call) {
  send_json(call.response, 200,
            {{"participants", bodies_of(call, [](const auto&) { return true; })}});
}

void put_exclusion(Call& call) {
  const json body = call.json();
  check_keys(body, {"excluded", "reason"});
  if (!body.contains("excluded") || !body["excluded"].is_boolean())
    throw bad_value("excluded", "must be true or false");
  if (!body.contains("reason") || !body["reason"].is_string() ||
      body["reason"].get_ref<const std::string&>().size() > 1000)
    throw bad_value("reason", "must be a text of at most 1000 bytes");
  const auto& pseudonym = call.path.at("pseudonym");
  if (!call.service.participants.exclude(call.path.at("id"), pseudonym,
                                         {body["excluded"], body["reason"], utc_now()}))
    throw nothing_here();
  const auto changed = bodies_of(
      call, [&](const auto& person) { return person.participant.pseudonym == pseudonym; });
  if (changed.empty()) throw nothing_here();
  send_json(call.response, 200, changed.front());
}

}  // namespace

void add_people_routes(std::vector<Route>& table) {
  const std::string all = "/api/v1/studies/{id}/participants";
  table.push_back({"GET", all, Access::researcher, list_participants});
  table.push_back({"PUT", all + "/{pseudonym}/exclusion", Access::researcher, put_exclusion});
}

}  // namespace penumbra::server::http
