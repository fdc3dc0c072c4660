#include <algorithm>
#include <charconv>

#include "server/http/body.h"
#include "server/http/clock.h"
#include "server/http/reply.h"
#include "server/http/secrets.h"
#include "server/http/service.h"
#include "study/answer.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

/// Someone not seen for so long gives the place to the next person, who completes the balance.
constexpr double abandoned_s = 2 * 3600.0;

std::string page_path(const std::string& token, std::size_t page) {
  return "/api/v1/participants/" + token + "/pages/" + std::to_string(page);
}

json image_at(const std::string& url, const study::Study& study) {
  return {{"url", url}, {"width", study.picture.width}, {"height", study.picture.height}};
}

/// A page as its participant may know it: a repeated page looks like any other.
json page_body(const FrozenStudy& frozen, const storage::ParticipantRecord& person,
               const study::PlannedPage& planned, std::size_t index, const json& answer) {
  const auto pictures = page_path(person.token, index) + "/pictures/";
  auto images = json::array();
  for (std::size_t slot = 0; slot < planned.slots.size(); ++slot) {
    images.push_back(image_at(pictures + std::to_string(slot), frozen.study));
    images.back()["slot"] = slot;
  }
  const bool practice = planned.kind == study::PageKind::practice;
  return {{"page", index},
          {"kind", practice ? "practice" : "ranking"},
          {"question", frozen.study.question.at(person.language)},
          {"images", images},
          {"reference", frozen.reference(planned).empty()
                            ? json(nullptr)
                            : image_at(pictures + "reference", frozen.study)},
          {"answer", answer}};
}

json enrolment_body(Service& service, const FrozenStudy& frozen,
                    const storage::ParticipantRecord& person) {
  const auto plan = frozen.plan(person.place);
  std::vector<json> answers(plan.pages.size());
  for (const auto& stored : service.participants.answers(person.key))
    answers.at(static_cast<std::size_t>(stored.page)) = stored.body;
  auto pages = json::array();
  for (std::size_t i = 0; i < plan.pages.size(); ++i)
    pages.push_back(page_body(frozen, person, plan.pages[i], i, answers[i]));
  const bool completed = !person.completed_at.empty();
  const auto& completion = frozen.study.completion;
  return {{"participant", person.token},
          {"withdrawal_code", person.withdrawal_code},
          {"study", person.study},
          {"status", completed ? "completed" : "started"},
          {"test", person.test},
          {"language", person.language},
          {"texts", study::welcome_document(frozen.study).at("texts").at(person.language)},
          {"widget", frozen.study.widget == study::Widget::numeric ? "numeric" : "shelves"},
          {"completion_code", completed ? json(completion.code) : json(nullptr)},
          {"completion_url", completed ? json(completion.url) : json(nullptr)},
          {"pages", pages}};
}

/// Optional text of a body.
std::string text_in(const json& body, const char* key, const std::string& otherwise) {
  if (!body.contains(key) || body.at(key).is_null()) return otherwise;
  if (!body.at(key).is_string()) throw bad_value(key, "must be a text");
  return body.at(key).get<std::string>();
}

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

storage::ParticipantRecord fresh_participant(Call& call, const FrozenStudy& frozen) {
  const json body = call.json();
  check_keys(body, {"language", "consent_version", "enrolment_id", "preview", "parameters"});
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
  if (body.contains("preview") && !body["preview"].is_boolean())
    throw bad_value("preview", "must be true or false");
  person.test = body.value("preview", false);
  if (person.test && !is_researcher(call.service, call.request))
    throw Error("unauthorized", "a preview needs the researcher's token", "preview");
  person.parameters = link_parameters(body, study);
  person.entered_at = utc_now();
  return person;
}

void enrol(Call& call) {
  if (behind_proxy(call.request) && !call.service.enrolments.allow(client_of(call.request)))
    throw Error("too_many", "too many people from one address; wait a little");
  const auto record = call.service.studies.open_version(call.path.at("id"));
  if (!record) {
    const auto latest = call.service.studies.latest_published(call.path.at("id"));
    if (!latest) throw nothing_here();
    throw Error("conflict", "the study is closed", "study");
  }
  const auto frozen = call.service.frozen.of(*record);
  const auto person = call.service.participants.enrol(fresh_participant(call, *frozen),
                                                      frozen->study.quota, utc_now(-abandoned_s));
  // The same enrolment again may be of an earlier version than the one that is open now.
  const auto theirs = call.service.frozen.of(person.study, person.version);
  send_json(call.response, 201, enrolment_body(call.service, *theirs, person));
}

storage::ParticipantRecord person_at(Call& call) {
  auto person = call.service.participants.find(call.path.at("token"));
  if (!person) {
    // A token that a damaged database does not know may be right: its answers wait in the browser.
    if (!call.service.database.healthy()) throw Error("storage", "the database is damaged");
    count_failure(call.service, call.request);
    throw nothing_here();
  }
  return *person;
}

void get_participant(Call& call) {
  const auto person = person_at(call);
  const auto frozen = call.service.frozen.of(person.study, person.version);
  send_json(call.response, 200, enrolment_body(call.service, *frozen, person));
}

/// Position of the page in the path; not found where the person has no such page.
std::size_t page_at(const Call& call, const study::EnrolmentPlan& plan) {
  const auto& text = call.path.at("page");
  std::size_t page = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), page);
  if (failure != std::errc{} || end != text.data() + text.size() || page >= plan.pages.size())
    throw nothing_here();
  return page;
}

void put_answer(Call& call) {
  const auto person = person_at(call);
  const auto frozen = call.service.frozen.of(person.study, person.version);
  const auto plan = frozen->plan(person.place);
  const auto page = page_at(call, plan);
  const auto& planned = plan.pages[page];
  const json body = call.json();
  const auto answer = study::parse_answer(body, frozen->study, planned.slots.size(),
                                          planned.kind == study::PageKind::practice);
  const storage::AnswerRecord fresh{static_cast<int>(page), answer.answer_id, body, utc_now()};
  const auto make_reply = [&](const std::string& replaced, int answered) -> json {
    return {{"answer_id", answer.answer_id},
            {"page", page},
            {"answered_at", fresh.answered_at},
            {"replaced", replaced.empty() ? json(nullptr) : json(replaced)},
            {"pages_answered", answered},
            {"pages", plan.pages.size()}};
  };
  send_json(call.response, 200,
            call.service.participants.answer(
                person, fresh, [&](const json& stored) { return study::same_answer(stored, body); },
                make_reply));
}

/// Equal headers for every picture of every page: nothing but its pixels tells it from another.
void get_picture(Call& call) {
  const auto person = person_at(call);
  const auto frozen = call.service.frozen.of(person.study, person.version);
  const auto plan = frozen->plan(person.place);
  const auto& planned = plan.pages[page_at(call, plan)];
  const auto& slot = call.path.at("slot");
  std::string digest;
  if (slot == "reference") {
    digest = frozen->reference(planned);
  } else {
    std::size_t number = 0;
    const auto [end, failure] = std::from_chars(slot.data(), slot.data() + slot.size(), number);
    if (failure == std::errc{} && end == slot.data() + slot.size())
      digest = frozen->picture(planned, number);
  }
  if (digest.empty()) throw nothing_here();
  const auto png = call.service.pictures.read(digest);
  call.response.status = 200;
  call.response.set_header("Cache-Control", "private, max-age=86400");
  call.response.set_content(png, "image/png");
}

/// Answers about the person: those the study asks for, checked; a comment and the brightness check.
json details_in(const json& body, const study::Study& study) {
  check_keys(body, {"demographics", "comment", "patches_seen"});
  const json given = body.value("demographics", json::object());
  if (!given.is_object()) throw bad_value("demographics", "must be an object");
  for (const auto& [name, value] : given.items()) {
    const auto asked = std::find_if(study.demographics.begin(), study.demographics.end(),
                                    [&, key = name](const auto& entry) { return entry.id == key; });
    if (asked == study.demographics.end())
      throw bad_value("demographics." + name, "is not asked for");
    const bool offered =
        std::any_of(asked->options.begin(), asked->options.end(),
                    [&, &answer = value](const auto& option) { return answer == option.id; });
    if (!offered) throw bad_value("demographics." + name, "must be one of the options");
  }
  for (const auto& asked : study.demographics)
    if (asked.required && !given.contains(asked.id))
      throw bad_value("demographics." + asked.id, "is required");
  if (text_in(body, "comment", "").size() > 5000)
    throw bad_value("comment", "must be at most 5000 bytes");
  if (body.contains("patches_seen") && !body["patches_seen"].is_number_unsigned())
    throw bad_value("patches_seen", "must be a whole number from 0");
  return body;
}

void complete(Call& call) {
  const auto person = person_at(call);
  const auto frozen = call.service.frozen.of(person.study, person.version);
  const auto details =
      person.completed_at.empty() ? details_in(call.json(), frozen->study) : json::object();
  call.service.participants.complete(
      person, static_cast<int>(frozen->plan(person.place).pages.size()), details, utc_now());
  send_json(call.response, 200,
            {{"completion_code", frozen->study.completion.code},
             {"completion_url", frozen->study.completion.url},
             {"withdrawal_code", person.withdrawal_code}});
}

void withdraw(Call& call) {
  const auto code = code_as_written(call.path.at("code"));
  if (!call.service.participants.withdraw(code, utc_now())) {
    count_failure(call.service, call.request);
    throw nothing_here();
  }
  call.response.status = 204;
}

/// A draft is not found: nobody learns of a study before it opens.
void get_welcome(Call& call) {
  const auto record = call.service.studies.latest_published(call.path.at("study"));
  if (!record) throw nothing_here();
  json body = study::welcome_document(call.service.frozen.of(*record)->study);
  body["status"] = record->status;
  send_json(call.response, 200, body);
}

}  // namespace

void add_participant_routes(std::vector<Route>& table) {
  const std::string person = "/api/v1/participants/{token}";
  const std::string page = person + "/pages/{page}";
  table.push_back({"POST", "/api/v1/studies/{id}/participants", Access::anyone, enrol});
  table.push_back({"GET", person, Access::anyone, get_participant});
  table.push_back({"PUT", page, Access::anyone, put_answer});
  table.push_back({"GET", page + "/pictures/{slot}", Access::anyone, get_picture});
  table.push_back({"POST", person + "/complete", Access::anyone, complete});
  table.push_back({"DELETE", "/api/v1/withdrawals/{code}", Access::anyone, withdraw});
  table.push_back({"GET", "/s/{study}/welcome", Access::anyone, get_welcome});
}

}  // namespace penumbra::server::http
