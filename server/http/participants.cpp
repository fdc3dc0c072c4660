// Answers of people: pages, pictures, the end.
#include <algorithm>
#include <charconv>

#include "server/http/body.h"
#include "server/http/clock.h"
#include "server/http/person_state.h"
#include "server/http/png.h"
#include "server/http/reply.h"
#include "server/http/secrets.h"
#include "server/http/service.h"
#include "server/http/webp.h"
#include "study/answer.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

/// Position of the page in the path; not found where the person has no such page.
std::size_t page_at(const Call& call, const study::EnrolmentPlan& plan) {
  const auto& text = call.path.at("page");
  std::size_t page = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), page);
  if (failure != std::errc{} || end != text.data() + text.size() || page >= plan.pages.size())
    throw nothing_here();
  return page;
}

/// A check that ended the study for a person is not undone by another answer.
void check_not_ended(Service& service, const FrozenStudy& frozen,
                     const storage::ParticipantRecord& person, const std::string& answer_id) {
  if (!study::can_screen_out(frozen.study)) return;
  const auto answers = service.participants.answers(person.key);
  for (const auto& stored : answers)
    if (stored.answer_id == answer_id) return;
  if (outcome_of(frozen, person, answers) == "screened_out")
    throw Error("conflict", "the study is over for this participant", "participant");
}

void put_answer(Call& call) {
  const auto person = person_at(call);
  const auto frozen = call.service.frozen.of(person.study, person.version);
  const auto plan = frozen->plan(person.place);
  const auto page = page_at(call, plan);
  const auto& planned = plan.pages[page];
  const json body = call.json();
  const auto answer =
      study::parse_answer(body, study::arm_of(frozen->study, plan), planned.slots.size(),
                          planned.kind == study::PageKind::practice);
  check_not_ended(call.service, *frozen, person, answer.answer_id);
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
                make_reply, utc_now(-60.0 * frozen->study.grace_minutes)));
}

/// A picture of a draft, drawn for a researcher who looks at it; publishing finds it in the cache.
std::string drawn(Service& service, const json& request) {
  if (const auto own = study::own_picture(request); !own.empty()) return service.pictures.read(own);
  const auto record = service.renders->submit(request);
  const auto over = service.renders->wait(record.id, service.options.render_deadline_s);
  if (!over || !is_over(*over)) throw Error("deadline", "the picture was not ready in time");
  if (over->status != "done") throw failure_of(*over);
  const auto png = service.renders->artefact(over->id, "image.png");
  if (!png) throw Error("storage", "the picture is gone");
  return pixels_only(*png);
}

/// The render request of one view of a slot, or of the reference shown beside the pictures.
json render_request(const FrozenStudy& frozen, const study::PlannedPage& planned,
                    std::optional<std::size_t> slot, std::size_t view) {
  const auto renders = study::page_renders(frozen.study, study::page_of(frozen.study, planned));
  return (slot ? renders.pictures.at(planned.slots.at(*slot)) : renders.shown_reference).at(view);
}

/// A whole number without a sign; none where a path has anything else.
std::optional<std::size_t> number_in(const std::string& text) {
  std::size_t number = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = failure == std::errc{} && end == text.data() + text.size();
  return whole ? std::optional(number) : std::nullopt;
}

/// Equal headers for every picture of every page: nothing but its pixels tells it from another.
void get_picture(Call& call) {
  const auto person = person_at(call);
  const auto frozen = call.service.frozen.of(person.study, person.version);
  const auto plan = frozen->plan(person.place);
  const auto& planned = plan.pages[page_at(call, plan)];
  const auto& slot = call.path.at("slot");
  std::vector<std::string> views;
  std::optional<std::size_t> number;
  if (slot == "reference")
    views = frozen->reference(planned);
  else if ((number = number_in(slot)))
    views = frozen->picture(planned, *number);
  const auto frame = call.path.find("frame");
  const auto view = frame == call.path.end()
                        ? std::optional(study::first_view(study::page_of(frozen->study, planned)))
                        : number_in(frame->second);
  if (!view || *view >= views.size()) throw nothing_here();
  const auto& digest = views[*view];
  const bool draft = person.test && digest == lost_picture;
  auto& pictures = call.service.pictures;
  // All pictures of a study have one size, so that those too large for WebP tell nothing either.
  const auto webp = !draft && takes_webp(call.request.get_header_value("Accept"))
                        ? pictures.read_webp(digest)
                        : std::nullopt;
  const auto bytes = draft  ? drawn(call.service, render_request(*frozen, planned, number, *view))
                     : webp ? *webp
                            : pictures.read(digest);
  call.response.status = 200;
  call.response.set_header("Vary", "Accept");
  call.response.set_header("Cache-Control", "private, max-age=86400");
  call.response.set_content(bytes, webp ? "image/webp" : "image/png");
}

void check_patches(const json& body) {
  if (body.contains("patches_seen") &&
      (!body["patches_seen"].is_number_unsigned() || body["patches_seen"] > study::dark_patches))
    throw bad_value("patches_seen",
                    "must be a whole number from 0 to " + std::to_string(study::dark_patches));
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
  check_patches(body);
  return body;
}

/// What was seen of the dark patches, told before the first page.
void put_screen(Call& call) {
  const auto person = person_at(call);
  const auto frozen = call.service.frozen.of(person.study, person.version);
  const json body = call.json();
  check_keys(body, {"patches_seen"});
  check_patches(body);
  if (!body.contains("patches_seen")) throw bad_value("patches_seen", "is required");
  const auto changed = call.service.participants.note_details(person, body);
  send_json(call.response, 200, enrolment_body(call.service, *frozen, changed));
}

void complete(Call& call) {
  const auto person = person_at(call);
  const auto frozen = call.service.frozen.of(person.study, person.version);
  auto status = outcome_of(*frozen, person, call.service.participants.answers(person.key));
  if (status != "screened_out") {
    const auto details =
        person.completed_at.empty() ? details_in(call.json(), frozen->study) : json::object();
    call.service.participants.complete(
        person, static_cast<int>(frozen->plan(person.place).pages.size()), details, utc_now());
    status = "completed";
  }
  const auto& codes = frozen->study.completion;
  const auto& end = status == "completed" ? codes.complete : codes.screened_out;
  send_json(call.response, 200,
            {{"status", status},
             {"completion_code", end.code},
             {"completion_url", end.url},
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

}  // namespace

void add_participant_routes(std::vector<Route>& table) {
  const std::string person = "/api/v1/participants/{token}";
  const std::string page = person + "/pages/{page}";
  table.push_back({"PUT", person + "/screen", Access::anyone, put_screen});
  table.push_back({"PUT", page, Access::anyone, put_answer});
  table.push_back({"GET", page + "/pictures/{slot}", Access::anyone, get_picture});
  table.push_back({"GET", page + "/pictures/{slot}/{frame}", Access::anyone, get_picture});
  table.push_back({"POST", person + "/complete", Access::anyone, complete});
  table.push_back({"DELETE", "/api/v1/withdrawals/{code}", Access::anyone, withdraw});
}

}  // namespace penumbra::server::http
