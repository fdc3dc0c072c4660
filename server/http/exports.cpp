// What leaves a study: rows, statistics, figures, the archive.
#include <algorithm>

#include "server/http/archive.h"
#include "server/http/reply.h"
#include "server/http/service.h"
#include "server/http/studies.h"
#include "study/statistics/report.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

void append_rows(const FrozenStudy& frozen, const storage::ParticipantData& person,
                 std::vector<study::ResponseRow>& rows) {
  const auto plan = frozen.plan(person.participant.place);
  for (const auto& stored : person.answers) {
    const auto& planned = plan.pages.at(static_cast<std::size_t>(stored.page));
    if (planned.kind == study::PageKind::practice) continue;
    const auto answer = study::parse_answer(stored.body, frozen.study, planned.slots.size());
    for (auto& row : study::response_rows(frozen.study, frozen.hash, person.participant.pseudonym,
                                          planned, stored.page, answer, stored.answered_at)) {
      row.included = !person.excluded();
      rows.push_back(std::move(row));
    }
  }
}

void set_flags(std::vector<study::ResponseRow>& rows, const json& flags) {
  std::map<std::string, std::string> names;
  for (const auto& flag : flags) {
    auto& list = names[flag.at("participant").get<std::string>()];
    const auto name = flag.at("flag").get<std::string>();
    if (list.find(name) == std::string::npos) list += (list.empty() ? "" : " ") + name;
  }
  for (auto& row : rows)
    if (const auto found = names.find(row.participant); found != names.end())
      row.flags = found->second;
}

void send_download(Call& call, const std::string& bytes, const std::string& type,
                   const std::string& name) {
  call.response.status = 200;
  call.response.set_header("Content-Disposition", "attachment; filename=\"" + name + "\"");
  call.response.set_content(bytes, type);
}

void get_responses(Call& call) {
  const auto frozen = published_at(call);
  send_download(call, study::write_responses(rows_of(call.service, *frozen)),
                "text/csv; charset=utf-8", frozen->study.id + "-responses.csv");
}

void get_results(Call& call) {
  const auto frozen = published_at(call);
  send_json(call.response, 200, results_of(*frozen, rows_of(call.service, *frozen)));
}

std::string participants_csv(Service& service, const FrozenStudy& frozen) {
  std::string text =
      "participant,entered_at,completed_at,pages_answered,language,consent_version,test,excluded,"
      "exclusion_reason,parameters,details\r\n";
  service.participants.each(frozen.study.id, frozen.version,
                            [&](const storage::ParticipantData& person) {
                              const auto& who = person.participant;
                              const std::vector<std::string> cells{
                                  who.pseudonym,
                                  who.entered_at,
                                  who.completed_at,
                                  std::to_string(person.answers.size()),
                                  who.language,
                                  who.consent_version,
                                  who.test ? "true" : "false",
                                  person.excluded() ? "true" : "false",
                                  person.excluded() ? person.exclusions.back().reason : "",
                                  who.parameters.dump(),
                                  who.details.dump()};
                              for (std::size_t i = 0; i < cells.size(); ++i)
                                text += (i == 0 ? "" : ",") + study::csv_text(cells[i]);
                              text += "\r\n";
                            });
  return text;
}

void get_export(Call& call) {
  const auto frozen = published_at(call);
  const auto rows = rows_of(call.service, *frozen);
  const auto report = results_of(*frozen, rows);
  const auto options = study::report_options(frozen->study);
  send_download(call,
                zip_of({{"responses.csv", study::write_responses(rows)},
                        {"participants.csv", participants_csv(call.service, *frozen)},
                        {"codebook.csv", study::write_codebook()},
                        {"study.json", frozen->study.document.dump(2) + "\n"},
                        {"results.json", report.dump(2) + "\n"},
                        {"results.txt", study::statistics_table(report, options)}}),
                "application/zip", frozen->study.id + "-export.zip");
}

}  // namespace

std::vector<study::ResponseRow> rows_of(Service& service, const FrozenStudy& frozen) {
  std::vector<study::ResponseRow> rows;
  service.participants.each(frozen.study.id, frozen.version,
                            [&](const storage::ParticipantData& person) {
                              if (!person.participant.test) append_rows(frozen, person, rows);
                            });
  set_flags(rows, study::screening_flags(rows, frozen.study.analysis.screening));
  return rows;
}

json results_of(const FrozenStudy& frozen, const std::vector<study::ResponseRow>& rows) {
  return study::statistics_report(rows, study::report_options(frozen.study));
}

void add_export_routes(std::vector<Route>& table) {
  const std::string one = "/api/v1/studies/{id}";
  table.push_back({"GET", one + "/responses.csv", Access::researcher, get_responses});
  table.push_back({"GET", one + "/results.json", Access::researcher, get_results});
  table.push_back({"GET", one + "/export.zip", Access::researcher, get_export});
}

}  // namespace penumbra::server::http
