// Entering a study, and how far a person is in it.
#include <algorithm>

#include "server/http/body.h"
#include "server/http/clock.h"
#include "server/http/guard.h"
#include "server/http/person_state.h"
#include "server/http/reply.h"
#include "server/http/secrets.h"
#include "server/http/service.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

/// Someone not seen for so long gives the place to the next person, who completes the balance.
constexpr double abandoned_s = 2 * 3600.0;

bool is_uuid(const std::string& text) {
  if (text.size() != 36) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool dash = i == 8 || i == 13 || i == 18 || i == 23;
    if (dash ? text[i] != '-' : std::isxdigit(static_cast<unsigned char>(text[i])) == 0)
      return false;
  }
  return true;
}

/// What of the link is kept: the parameters that the study names, and no other.
json link_parameters(const json& body, const study::Study& study) {
  json kept = json::object();
  const json given = body.value("parameters", json::object());
  if (!given.is_object()) throw bad_value("parameters", "must be an object");
  for (const auto& [name, value] : given.items()) {
    if (!value.is_string() || value.get_ref<const std::string&>().size() > 200)
      throw bad_value("parameters." + name, "must be a text of at most 200 bytes");
    const auto& named = study.id_parameters;
    if (std::find(named.begin(), named.end(), name) != named.end()) kept[name] = value;
  }
  return kept;
}

storage::ParticipantRecord fresh_participant(const json& body, const FrozenStudy& frozen) {
  const auto& study = frozen.study;
  storage::ParticipantRecord person;
  person.pseudonym = "p-" + random_token(9);
  person.study = study.id;
  person.version = frozen.version;
  person.token = random_token();
  person.withdrawal_code = random_code(6);
  person.language = text_in(body, "language", study.languages.front());
  if (std::find(study.languages.begin(), study.languages.end(), person.language) ==
      study.languages.end())
    person.language = study.languages.front();
  person.consent_version = text_in(body, "consent_version", "");
  if (!person.consent_version.empty() && person.consent_version != study.consent.version)
    throw Error("conflict", "the consent text has changed; read it again", "consent_version");
  person.enrolment_id = text_in(body, "enrolment_id", random_uuid());
  if (!is_uuid(person.enrolment_id)) throw bad_value("enrolment_id", "must be a UUID");
  person.test = body.value("preview", false);
  person.parameters = link_parameters(body, study);
  person.person_id = person.parameters.value(study.person_parameter, "");
  person.entered_at = utc_now();
  return person;
}

/// The open version; for a preview any version, drafts included.
storage::StudyRecord version_to_enter(Call& call, const json& body) {
  const auto& id = call.path.at("id");
  auto& studies = call.service.studies;
  const bool keyed =
      body.is_object();  // anything else is refused once it is known that one may enter
  if (keyed && body.contains("preview") && !body["preview"].is_boolean())
    throw bad_value("preview", "must be true or false");
  if (keyed && body.value("preview", false)) {
    if (!is_researcher(call.service, call.request))
      throw Error("unauthorized", "a preview needs the researcher's token", "preview");
    if (body.contains("version") && !body["version"].is_number_unsigned())
      throw bad_value("version", "must be a whole number from 1");
    const auto record = body.contains("version") ? studies.find(id, body["version"].get<int>())
                                                 : studies.current(id);
    if (!record) throw nothing_here();
    return *record;
  }
  if (keyed && body.contains("version"))
    throw bad_value("version", "only a preview chooses its version");
  if (const auto open = studies.open_version(id)) return *open;
  if (!studies.latest_published(id)) throw nothing_here();
  throw Error("conflict", "the study is closed", "study");
}

void enrol(Call& call) {
  if (behind_proxy(call.request) && !call.service.enrolments.allow(client_of(call.request)))
    throw Error("too_many", "too many people from one address; wait a little");
  const json body = call.json();
  const auto version = version_to_enter(call, body);
  check_keys(body,
             {"language", "consent_version", "enrolment_id", "preview", "version", "parameters"});
  const auto frozen = call.service.frozen.of(version);
  const auto person =
      call.service.participants.enrol(fresh_participant(body, *frozen), frozen->study.quota,
                                      utc_now(-abandoned_s), !frozen->study.several_entries);
  // The same enrolment again may be of an earlier version than the one that is open now.
  const auto theirs = call.service.frozen.of(person.study, person.version);
  auto reply = enrolment_body(call.service, *theirs, person);
  // With it and the study's seed a simulation knows what it is shown; participants are never told.
  if (is_researcher(call.service, call.request)) reply["place"] = person.place;
  send_json(call.response, 201, reply);
}

void get_participant(Call& call) {
  const auto person = person_at(call);
  const auto frozen = call.service.frozen.of(person.study, person.version);
  send_json(call.response, 200, enrolment_body(call.service, *frozen, person));
}

/// A draft is found by researchers who ask for its version: no others learn of a study before it
/// opens.
std::optional<storage::StudyRecord> welcoming_version(Call& call) {
  const auto& id = call.path.at("study");
  auto& studies = call.service.studies;
  const int version = static_cast<int>(number_in_query(call.request, "version", 1, 1e6, 0));
  if (version > 0 && is_researcher(call.service, call.request)) return studies.find(id, version);
  if (auto open = studies.open_version(id)) return open;
  return studies.latest_published(id);
}

void get_welcome(Call& call) {
  const auto record = welcoming_version(call);
  if (!record) throw nothing_here();
  const auto frozen = call.service.frozen.of(*record);
  const auto& study = frozen->study;
  json body = study::welcome_document(study);
  body["status"] = record->status;
  const bool full = record->status == "open" &&
                    call.service.participants.is_full(record->id, record->version, study.quota);
  body["full"] = full;
  body["completion_code"] = full ? json(study.completion.over_quota.code) : json(nullptr);
  body["completion_url"] = full ? json(study.completion.over_quota.url) : json(nullptr);
  send_json(call.response, 200, body);
}

}  // namespace

void add_enrolment_routes(std::vector<Route>& table) {
  table.push_back({"POST", "/api/v1/studies/{id}/participants", Access::anyone, enrol});
  table.push_back({"GET", "/api/v1/participants/{token}", Access::anyone, get_participant});
  table.push_back({"GET", "/s/{study}/welcome", Access::anyone, get_welcome});
}

}  // namespace penumbra::server::http
