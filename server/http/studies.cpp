#include "server/http/studies.h"

#include "scenes/json_text.h"
#include "server/http/body.h"
#include "server/http/clock.h"
#include "server/http/own_pictures.h"
#include "server/http/png.h"
#include "server/http/reply.h"
#include "server/http/scene_upload.h"
#include "server/http/secrets.h"
#include "server/http/service.h"
#include "study/enrolment.h"
#include "study/faults.h"

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

json text_or_null(const std::string& text) {
  return text.empty() ? json(nullptr) : json(text);
}

json counts_body(Service& service, const storage::StudyRecord& record) {
  const auto counts = service.studies.counts(record.id, record.version);
  return {{"entered", counts.entered},
          {"completed", counts.completed},
          {"withdrawn", counts.withdrawn},
          {"tests", counts.tests}};
}

json progress_body(const storage::StudyRecord& record) {
  return {{"pictures", record.pictures_done},
          {"pictures_total", record.pictures_total},
          {"error", record.error}};
}

json measures_body(Service& service, const storage::StudyRecord& record) {
  const auto pictures = service.studies.picture_counts(record.id, record.version);
  return {{"pictures", pictures.measured},
          {"pictures_total", pictures.frozen},
          {"at_work", service.publisher.is_measuring(record)}};
}

json version_body(Service& service, const storage::StudyRecord& record) {
  return {{"version", record.version},
          {"status", record.status},
          {"hash", text_or_null(record.hash)},
          {"created_at", record.created_at},
          {"opened_at", text_or_null(record.opened_at)},
          {"closed_at", text_or_null(record.closed_at)},
          {"participants", counts_body(service, record)},
          {"progress", progress_body(record)}};
}

json summary_of(Service& service, const storage::StudyRecord& record) {
  const auto study = study::parse_study(record.document);
  auto versions = json::array();
  for (const auto& version : service.studies.versions(record.id))
    versions.push_back(version_body(service, version));
  return {{"id", record.id},
          {"title", study.title.at(study.languages.front())},
          {"status", record.status},
          {"version", record.version},
          {"hash", text_or_null(record.hash)},
          {"participants", counts_body(service, record)},
          {"versions", versions},
          {"links", links_of(record.id)}};
}

/// Answers per picture and position of every page, so that a gap in the balance is seen.
json cells_of(const study::Page& page, const std::vector<std::vector<int>>& counts) {
  auto list = json::array();
  for (std::size_t i = 0; i < page.pictures.size(); ++i)
    list.push_back({{"picture", page.pictures[i].id}, {"answers_by_slot", counts[i]}});
  return list;
}

/// Answers so far per page of the study and cell of its order; the order of pages differs between
/// people.
json answers_per_page(Service& service, const storage::StudyRecord& record) {
  const auto study = study::parse_study(record.document);
  std::vector<int> answers(study.pages.size(), 0);
  std::vector<std::vector<std::vector<int>>> cells;
  for (const auto& page : study.pages)
    cells.emplace_back(page.pictures.size(), std::vector<int>(page.pictures.size(), 0));
  for (const auto& person : service.participants.progress(record.id, record.version)) {
    const auto plan = study::plan_enrolment(study, record.seed, person.place);
    for (const int page : person.pages) {
      const auto& planned = plan.pages.at(static_cast<std::size_t>(page));
      if (planned.kind != study::PageKind::ranking) continue;
      ++answers.at(planned.page);
      for (std::size_t slot = 0; slot < planned.slots.size(); ++slot)
        ++cells[planned.page][planned.slots[slot]][slot];
    }
  }
  auto list = json::array();
  for (std::size_t i = 0; i < answers.size(); ++i)
    list.push_back({{"page", i},
                    {"id", study.pages[i].id},
                    {"scene", study.pages[i].scene},
                    {"answers", answers[i]},
                    {"cells", cells_of(study.pages[i], cells[i])}});
  return list;
}

/// How many people each way of giving ranks has; empty where there is one only.
json arms_body(Service& service, const storage::StudyRecord& record) {
  auto list = json::array();
  const auto study = study::parse_study(record.document);
  if (study.arms.size() == 1) return list;
  for (const auto& arm : study.arms)
    list.push_back({{"arm", arm.id},
                    {"widget", study::widget_name(arm.widget)},
                    {"entered", 0},
                    {"answered_all", 0}});
  study::Permutations permutations(record.seed);
  for (const auto& person : service.participants.progress(record.id, record.version)) {
    const auto plan = study::plan_enrolment(study, permutations, person.place);
    auto& arm = list[plan.arm];
    arm["entered"] = arm["entered"].get<int>() + 1;
    if (person.pages.size() == plan.pages.size())
      arm["answered_all"] = arm["answered_all"].get<int>() + 1;
  }
  return list;
}

json body_of(Service& service, const storage::StudyRecord& record) {
  json body = summary_of(service, record);
  body["progress"] = progress_body(record);
  body["measures"] = measures_body(service, record);
  body["seed"] = record.seed;
  body["grace_minutes"] = study::parse_study(record.document).grace_minutes;
  body["document"] = record.document;
  body["arms"] = arms_body(service, record);
  body["scenes"] = answers_per_page(service, record);
  return body;
}

/// The version that the query names, otherwise the current one.
storage::StudyRecord study_at(Call& call) {
  const auto& id = call.path.at("id");
  const int version = static_cast<int>(number_in_query(call.request, "version", 1, 1e6, 0));
  const auto record =
      version > 0 ? call.service.studies.find(id, version) : call.service.studies.current(id);
  if (!record) throw nothing_here();
  return *record;
}

/// What a call that changed a version returns.
void send_version(Call& call, int state, int version) {
  send_json(call.response, state,
            body_of(call.service, *call.service.studies.find(call.path.at("id"), version)));
}

void list_studies(Call& call) {
  auto list = json::array();
  for (const auto& record : call.service.studies.list())
    list.push_back(summary_of(call.service, record));
  send_json(call.response, 200, {{"studies", list}});
}

/// Where in the document a picture's request comes from.
std::string picture_path(const study::Study& study, const std::string& page,
                         const json& page_document, std::size_t picture) {
  const bool own = page_document.contains("techniques");
  const auto& list = own ? page_document.at("techniques") : study.document.at("techniques");
  if (picture >= list.size()) return page + ".reference";
  return (own ? page + "." : "") + "techniques[" + std::to_string(picture) + "]";
}

/// Checks that one's own picture is here, and no larger or smaller than those beside it: its size
/// would tell it from them.
void check_own_picture(Service& service, const study::Study& study, const std::string& name,
                       const std::string& path, study::FaultList& faults) {
  const auto png = service.pictures.read_stored(name);
  if (!png)
    return faults.add(bad_value(path + ".picture", "no such picture was uploaded to this server"));
  const auto [width, height] = size_of_png(*png);
  const auto text = [](auto w, auto h) { return std::to_string(w) + " by " + std::to_string(h); };
  const auto wanted_width = study.picture.at("width").get<std::uint32_t>();
  const auto wanted_height = study.picture.at("height").get<std::uint32_t>();
  if (width != wanted_width || height != wanted_height)
    faults.add(bad_value(path + ".picture", "has " + text(width, height) +
                                                " pixels; the study's pictures (`picture`) have " +
                                                text(wanted_width, wanted_height)));
}

/// Asks for every picture of a page whether it could be drawn.
void check_pictures(Service& service, const study::Study& study, const study::Page& page,
                    const std::string& path, const json& document, study::FaultList& faults) {
  const auto pictures = study::page_renders(study, page).pictures;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const json& request = pictures[i].front();  // views differ by where the camera stands
    if (const auto own = study::own_picture(request); !own.empty()) {
      check_own_picture(service, study, own, picture_path(study, path, document, i), faults);
      continue;
    }
    try {
      service.renders->check(request);
    } catch (const Error& error) {
      if (error.code != "bad_value" && error.code != "not_found" && error.code != "unsupported")
        throw;
      auto field = picture_path(study, path, document, i);
      if (error.field == "scene" || error.field == "camera")
        field = path + "." + error.field;
      else if (error.field.starts_with("camera_path"))
        field = path + ".orbit";
      else if (request.contains(error.field) && error.field != "technique")
        field = "picture." + error.field;
      else if (error.field != "technique" && !error.field.empty())
        field += ".parameters." + error.field;
      faults.add(bad_value(field, error.what()));
    }
  }
}

/// Everything that is wrong with a study, its scenes, cameras, techniques and parameters included.
study::Study checked_study(Call& call) {
  if (!is_zip(call.body) && call.body.size() > largest_study)
    throw Error("too_large", "at most " + std::to_string(largest_study) + " bytes", "body");
  auto study =
      study::parse_study(is_zip(call.body) ? study_of_zip(call.service, call.body) : call.json());
  study::FaultList faults;
  const auto& document = study.document;
  for (std::size_t i = 0; i < study.pages.size(); ++i)
    check_pictures(call.service, study, study.pages[i], "pages[" + std::to_string(i) + "]",
                   document.at("pages")[i], faults);
  if (study.practice)
    check_pictures(call.service, study, study.practice->page, "practice", document.at("practice"),
                   faults);
  faults.throw_if_any();
  return study;
}

void send_faults(Call& call, const study::StudyFaults& faults) {
  auto body = error_body(faults);
  for (const auto& fault : faults.all)
    body["error"]["errors"].push_back({{"field", fault.field}, {"message", fault.what()}});
  send_json(call.response, 400, body);
}

void post_study(Call& call) try {
  const auto study = checked_study(call);
  const auto record =
      call.service.studies.put_draft(study.id, study.document, random_seed(), utc_now());
  call.response.set_header("Location", "/api/v1/studies/" + record.id);
  // A document that was published already is no new version.
  send_json(call.response, record.status == "draft" ? 201 : 200, body_of(call.service, record));
} catch (const study::StudyFaults& faults) {
  send_faults(call, faults);
}

void get_study(Call& call) {
  send_json(call.response, 200, body_of(call.service, study_at(call)));
}

void publish_study(Call& call) {
  const auto draft = call.service.studies.draft(call.path.at("id"));
  const auto record = draft ? *draft : study_at(call);
  if (record.status == "closed")
    throw Error("conflict", "the study is closed; open it again, or store a new version first",
                "status");
  if (record.status == "draft") call.service.publisher.publish(record);
  if (record.status == "publishing") call.service.publisher.resume(record);
  send_version(call, record.status == "open" ? 200 : 202, record.version);
}

void measure_study(Call& call) {
  const auto frozen = published_at(call);
  const auto record = *call.service.studies.find(frozen->study.id, frozen->version);
  call.service.publisher.measure(record);
  send_version(call, 202, record.version);
}

void close_study(Call& call) {
  const auto open = call.service.studies.open_version(call.path.at("id"));
  const auto record = open ? *open : study_at(call);
  if (record.status != "closed") call.service.studies.close(record.id, utc_now());
  send_version(call, 200, record.version);
}

void reopen_study(Call& call) {
  const auto& id = call.path.at("id");
  const bool chosen = call.request.has_param("version");
  const auto newest = call.service.studies.latest_published(id);
  const auto record = chosen || !newest ? study_at(call) : *newest;
  call.service.studies.reopen(id, record.version);
  send_version(call, 200, record.version);
}

void delete_draft(Call& call) {
  const auto draft = call.service.studies.draft(call.path.at("id"));
  if (!draft) {
    study_at(call);
    throw Error("conflict", "the study has no draft", "status");
  }
  call.service.studies.remove_draft(draft->id, draft->version);
  call.response.status = 204;
}

/// The study file, to be kept, changed and stored again.
void get_document(Call& call) {
  const auto record = study_at(call);
  call.response.status = 200;
  call.response.set_header("Content-Disposition",
                           "attachment; filename=\"" + record.id + ".json\"");
  call.response.set_content(scenes::json_text(record.document, 2) + "\n", "application/json");
}

}  // namespace

std::shared_ptr<const FrozenStudy> published_at(Call& call) {
  const auto& id = call.path.at("id");
  const int version = static_cast<int>(number_in_query(call.request, "version", 1, 1e6, 0));
  const auto record = version > 0 ? call.service.studies.find(id, version)
                                  : call.service.studies.latest_published(id);
  if (record && (record->status == "open" || record->status == "closed"))
    return call.service.frozen.of(*record);
  if (!call.service.studies.current(id)) throw nothing_here();
  throw Error("conflict", "the study was not published yet", "status");
}

void add_study_routes(std::vector<Route>& table) {
  const std::string all = "/api/v1/studies";
  const std::string one = all + "/{id}";
  table.push_back({"GET", all, Access::researcher, list_studies});
  table.push_back({"POST", all, Access::researcher, post_study, largest_upload});
  table.push_back({"GET", one, Access::researcher, get_study});
  table.push_back({"POST", one + "/publish", Access::researcher, publish_study});
  table.push_back({"POST", one + "/measure", Access::researcher, measure_study});
  table.push_back({"POST", one + "/close", Access::researcher, close_study});
  table.push_back({"POST", one + "/reopen", Access::researcher, reopen_study});
  table.push_back({"DELETE", one + "/draft", Access::researcher, delete_draft});
  table.push_back({"GET", one + "/study.json", Access::researcher, get_document});
}

}  // namespace penumbra::server::http
