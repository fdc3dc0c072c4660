#include "server/http/person_state.h"

#include "server/http/clock.h"
#include "server/http/guard.h"
#include "server/http/reply.h"
#include "server/http/service.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

std::string page_path(const std::string& token, std::size_t page) {
  return "/api/v1/participants/" + token + "/pages/" + std::to_string(page);
}

/// A picture of a page: with `frames`, the addresses of its views, where the page can be turned.
json image_at(const std::string& url, const study::Study& study, const study::Page& page) {
  json image = {
      {"url", url}, {"width", study.picture.at("width")}, {"height", study.picture.at("height")}};
  if (!page.orbit) return image;
  image["frames"] = json::array();
  for (int frame = 0; frame < page.orbit->frames; ++frame)
    image["frames"].push_back(url + "/" + std::to_string(frame));
  image["url"] = image["frames"][study::first_view(page)];
  return image;
}

/// Slots of a practice page, the most realistic first: it is never counted, and people learn from
/// it.
std::vector<std::size_t> right_order(const study::PlannedPage& planned) {
  std::vector<std::size_t> order(planned.slots.size());
  for (std::size_t slot = 0; slot < order.size(); ++slot) order.at(planned.slots[slot]) = slot;
  return order;
}

/// A page as its participant may know it: a repeated page looks like any other.
json page_body(const FrozenStudy& frozen, const storage::ParticipantRecord& person,
               const study::PlannedPage& planned, std::size_t index, const json& answer) {
  const auto pictures = page_path(person.token, index) + "/pictures/";
  const auto& shown = study::page_of(frozen.study, planned);
  auto images = json::array();
  for (std::size_t slot = 0; slot < planned.slots.size(); ++slot) {
    images.push_back(image_at(pictures + std::to_string(slot), frozen.study, shown));
    images.back()["slot"] = slot;
  }
  const bool practice = planned.kind == study::PageKind::practice;
  const auto& question = shown.question.empty() ? frozen.study.question : shown.question;
  return {{"page", index},
          {"kind", practice ? "practice" : "ranking"},
          {"question", question.at(person.language)},
          {"images", images},
          {"reference", frozen.reference(planned).empty()
                            ? json(nullptr)
                            : image_at(pictures + "reference", frozen.study, shown)},
          {"right_order", practice ? json(right_order(planned)) : json(nullptr)},
          {"answer", answer}};
}

/// Until when a version that is closed takes answers of those who were amid it.
std::string last_moment(const storage::StudyRecord& record, const study::Study& study) {
  return utc_later(record.closed_at, 60.0 * study.grace_minutes);
}

}  // namespace

study::PersonChecks checks_of(const FrozenStudy& frozen, const storage::ParticipantRecord& person,
                              const std::vector<storage::AnswerRecord>& answers) {
  std::vector<std::pair<std::size_t, json>> bodies;
  for (const auto& stored : answers)
    bodies.emplace_back(static_cast<std::size_t>(stored.page), stored.body);
  return study::checks_of(frozen.study, frozen.plan(person.place), bodies, person.details);
}

std::string outcome_of(const FrozenStudy& frozen, const storage::ParticipantRecord& person,
                       const std::vector<storage::AnswerRecord>& answers) {
  if (study::can_screen_out(frozen.study) &&
      study::is_screened_out(frozen.study, checks_of(frozen, person, answers)))
    return "screened_out";
  return person.completed_at.empty() ? "" : "completed";
}

json enrolment_body(Service& service, const FrozenStudy& frozen,
                    const storage::ParticipantRecord& person) {
  const auto plan = frozen.plan(person.place);
  const auto stored_answers = service.participants.answers(person.key);
  std::vector<json> answers(plan.pages.size());
  for (const auto& stored : stored_answers)
    answers.at(static_cast<std::size_t>(stored.page)) = stored.body;
  const auto& arm = study::arm_of(frozen.study, plan);
  auto pages = json::array();
  for (std::size_t i = 0; i < plan.pages.size(); ++i)
    pages.push_back(page_body(frozen, person, plan.pages[i], i, answers[i]));
  auto status = outcome_of(frozen, person, stored_answers);
  const bool ended = !status.empty();
  const auto& codes = frozen.study.completion;
  const auto& completion = status == "screened_out" ? codes.screened_out : codes.complete;
  json closes_at = nullptr;
  if (const auto record = service.studies.find(person.study, person.version);
      !ended && record && record->status == "closed") {
    closes_at = last_moment(*record, frozen.study);
    // With every page answered, taking part can be finished at any time.
    if (closes_at < utc_now() && stored_answers.size() < plan.pages.size()) status = "over";
  }
  return {
      {"participant", person.token},
      {"withdrawal_code", person.withdrawal_code},
      {"study", person.study},
      {"status", status.empty() ? "started" : status},
      {"answered", stored_answers.size()},
      {"closes_at", closes_at},
      {"checks_end", study::can_screen_out(frozen.study)},
      {"test", person.test},
      {"language", person.language},
      {"texts", study::welcome_document(frozen.study).at("texts").at(person.language)},
      {"widget", study::widget_name(arm.widget)},
      {"best_digit", arm.widget == study::Widget::numeric ? json(arm.best_digit) : json(nullptr)},
      {"completion_code", ended ? json(completion.code) : json(nullptr)},
      {"completion_url", ended ? json(completion.url) : json(nullptr)},
      {"pages", pages}};
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

}  // namespace penumbra::server::http
