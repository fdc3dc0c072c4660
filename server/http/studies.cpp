#include "server/http/studies.h"

#include <algorithm>

#include "server/http/body.h"
#include "server/http/clock.h"
#include "server/http/reply.h"
#include "server/http/secrets.h"
#include "server/http/service.h"
#include "server/http/study_export.h"
#include "study/statistics/report.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

json links_of(const std::string& id) {
  const auto self = "/api/v1/studies/" + id;
  return {{"self", self},
          {"participant_page", "/s/" + id},
          {"participants", self + "/participants"},
          {"responses", self + "/responses.csv"},
          {"results", self + "/results.json"},
          {"report", self + "/report.html"},
          {"figures", self + "/figures"},
          {"export", self + "/export.zip"}};
}

json summary_of(Service& service, const storage::StudyRecord& record) {
  const auto study = study::parse_study(record.document);
  const auto counts = service.studies.counts(record.id, record.version);
  return {{"id", record.id},
          {"title", study.title.at(study.languages.front())},
          {"status", record.status},
          {"version", record.version},
          {"hash", record.hash.empty() ? json(nullptr) : json(record.hash)},
          {"participants",
           {{"entered", counts.entered},
            {"completed", counts.completed},
            {"withdrawn", counts.withdrawn},
            {"tests", counts.tests}}},
          {"links", links_of(record.id)}};
}

/// Answers so far per page of the study; the order of pages differs between people.
json answers_per_page(Service& service, const storage::StudyRecord& record) {
  const auto study = study::parse_study(record.document);
  std::vector<int> answers(study.pages.size(), 0);
  for (const auto& person : service.participants.progress(record.id, record.version)) {
    const auto plan = study::plan_enrolment(study, record.seed, person.place);
    for (const int page : person.pages) {
      const auto& planned = plan.pages.at(static_cast<std::size_t>(page));
      if (planned.kind == study::PageKind::ranking) ++answers.at(planned.page);
    }
  }
  auto list = json::array();
  for (std::size_t i = 0; i < answers.size(); ++i)
    list.push_back({{"page", i}, {"scene", study.pages[i].scene}, {"answers", answers[i]}});
  return list;
}

json body_of(Service& service, const storage::StudyRecord& record) {
  json body = summary_of(service, record);
  body["progress"] = {{"pictures", record.pictures_done},
                      {"pictures_total", record.pictures_total},
                      {"error", record.error}};
  body["document"] = record.document;
  body["scenes"] = answers_per_page(service, record);
  return body;
}

storage::StudyRecord study_at(Call& call) {
  const auto record = call.service.studies.latest(call.path.at("id"));
  if (!record) throw nothing_here();
  return *record;
}

void list_studies(Call& call) {
  auto list = json::array();
  for (const auto& record : call.service.studies.list())
    list.push_back(summary_of(call.service, record));
  send_json(call.response, 200, {{"studies", list}});
}

void post_study(Call& call) {
  const auto study = study::parse_study(call.json());
  const auto record =
      call.service.studies.put_draft(study.id, study.document, random_seed(), utc_now());
  call.response.set_header("Location", "/api/v1/studies/" + record.id);
  send_json(call.response, 201, body_of(call.service, record));
}

void get_study(Call& call) {
  send_json(call.response, 200, body_of(call.service, study_at(call)));
}

void publish_study(Call& call) {
  const auto record = study_at(call);
  if (record.status == "closed")
    throw Error("conflict", "the study is closed; store a new version first", "status");
  if (record.status == "draft") call.service.publisher.publish(record);
  if (record.status == "publishing") call.service.publisher.resume(record);
  send_json(call.response, record.status == "open" ? 200 : 202,
            body_of(call.service, study_at(call)));
}

void close_study(Call& call) {
  const auto record = study_at(call);
  if (record.status != "closed") call.service.studies.close(record.id, utc_now());
  send_json(call.response, 200, body_of(call.service, study_at(call)));
}

/// Flags by pseudonym.
std::map<std::string, json> flags_by_participant(const json& flags) {
  std::map<std::string, json> by_participant;
  for (const auto& flag : flags) {
    auto& list = by_participant[flag.at("participant").get<std::string>()];
    if (list.is_null()) list = json::array();
    list.push_back(flag);
  }
  return by_participant;
}

void list_participants(Call& call) {
  const auto frozen = published_at(call);
  const auto flags = flags_by_participant(study::screening_flags(
      rows_of(call.service.participants, *frozen), frozen->study.analysis.screening));
  auto list = json::array();
  call.service.participants.each(
      frozen->study.id, frozen->version, [&](const storage::ParticipantData& person) {
        const auto found = flags.find(person.participant.pseudonym);
        list.push_back(participant_body(*frozen, person,
                                        found == flags.end() ? json::array() : found->second));
      });
  send_json(call.response, 200, {{"participants", list}});
}

void put_exclusion(Call& call) {
  const json body = call.json();
  check_keys(body, {"excluded", "reason"});
  if (!body.contains("excluded") || !body["excluded"].is_boolean())
    throw bad_value("excluded", "must be true or false");
  if (!body.contains("reason") || !body["reason"].is_string() ||
      body["reason"].get_ref<const std::string&>().size() > 1000)
    throw bad_value("reason", "must be a text of at most 1000 bytes");
  const auto frozen = published_at(call);
  const auto& pseudonym = call.path.at("pseudonym");
  if (!call.service.participants.exclude(frozen->study.id, pseudonym,
                                         {body["excluded"], body["reason"], utc_now()}))
    throw nothing_here();
  const auto flags = flags_by_participant(study::screening_flags(
      rows_of(call.service.participants, *frozen), frozen->study.analysis.screening));
  json changed;
  call.service.participants.each(
      frozen->study.id, frozen->version, [&](const storage::ParticipantData& person) {
        if (person.participant.pseudonym != pseudonym) return;
        const auto found = flags.find(pseudonym);
        changed =
            participant_body(*frozen, person, found == flags.end() ? json::array() : found->second);
      });
  if (changed.is_null()) throw nothing_here();
  send_json(call.response, 200, changed);
}

}  // namespace

std::shared_ptr<const FrozenStudy> published_at(Call& call) {
  const auto& id = call.path.at("id");
  const int version = static_cast<int>(number_in_query(call.request, "version", 1, 1e6, 0));
  const auto record = version > 0 ? call.service.studies.find(id, version)
                                  : call.service.studies.latest_published(id);
  if (record && (record->status == "open" || record->status == "closed"))
    return call.service.frozen.of(*record);
  if (!call.service.studies.latest(id)) throw nothing_here();
  throw Error("conflict", "the study was not published yet", "status");
}

json participant_body(const FrozenStudy& frozen, const storage::ParticipantData& person,
                      const json& flags) {
  const auto& who = person.participant;
  auto history = json::array();
  for (const auto& decision : person.exclusions)
    history.push_back({{"excluded", decision.excluded},
                       {"reason", decision.reason},
                       {"at", decision.decided_at}});
  return {{"participant", who.pseudonym},
          {"entered_at", who.entered_at},
          {"completed_at", who.completed_at.empty() ? json(nullptr) : json(who.completed_at)},
          {"answered", person.answers.size()},
          {"pages", frozen.plan(who.place).pages.size()},
          {"language", who.language},
          {"test", who.test},
          {"excluded", person.excluded()},
          {"exclusion_reason", person.excluded() ? person.exclusions.back().reason : ""},
          {"flags", flags},
          {"history", history}};
}

void add_study_routes(std::vector<Route>& table) {
  const std::string all = "/api/v1/studies";
  const std::string one = all + "/{id}";
  constexpr std::size_t study_document = 4 << 20;
  table.push_back({"GET", all, Access::researcher, list_studies});
  table.push_back({"POST", all, Access::researcher, post_study, study_document});
  table.push_back({"GET", one, Access::researcher, get_study});
  table.push_back({"POST", one + "/publish", Access::researcher, publish_study});
  table.push_back({"POST", one + "/close", Access::researcher, close_study});
  table.push_back({"GET", one + "/participants", Access::researcher, list_participants});
  table.push_back(
      {"PUT", one + "/participants/{pseudonym}/exclusion", Access::researcher, put_exclusion});
}

}  // namespace penumbra::server::http
