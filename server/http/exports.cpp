// What leaves a study: rows, statistics, figures, the report, the archive.
#include <fstream>

#include "server/http/body.h"
#include "server/http/measured_pictures.h"
#include "server/http/reply.h"
#include "server/http/service.h"
#include "server/http/studies.h"
#include "server/storage/folder_files.h"
#include "study/statistics/report.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

StudyExport export_at(Call& call) {
  return export_of(call.service, published_at(call));
}

std::filesystem::path work_folder(const Call& call) {
  return call.service.folder.path() / storage::exports_name;
}

void tell_damage(Call& call) {
  const auto damage = call.service.database.damage();
  if (!damage.empty())
    call.response.set_header("Penumbra-Damaged-Rows", std::to_string(damage.size()));
}

/// Sends a file piece by piece. It is unlinked at once: what was opened stays until it was sent.
void send_download(Call& call, const TemporaryFile& file, const std::string& type,
                   const std::string& name) {
  auto stream = std::make_shared<std::ifstream>(file.path(), std::ios::binary);
  const auto size = std::filesystem::file_size(file.path());
  if (!*stream) throw Error("storage", "the export cannot be read back");
  call.response.status = 200;
  call.response.set_header("Content-Disposition", "attachment; filename=\"" + name + "\"");
  tell_damage(call);
  call.response.set_content_provider(
      size, type, [stream](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        std::string piece(std::min<std::size_t>(length, 256 << 10), '\0');
        stream->seekg(static_cast<std::streamoff>(offset));
        stream->read(piece.data(), static_cast<std::streamsize>(piece.size()));
        return stream->gcount() == static_cast<std::streamsize>(piece.size()) &&
               sink.write(piece.data(), piece.size());
      });
}

std::string download_name(const Call& call, const char* what) {
  return call.path.at("id") + "-" + what;
}

void get_responses(Call& call) {
  auto exported = export_at(call);
  const TemporaryFile file(work_folder(call), ".csv");
  exported.write_responses(file.path());
  send_download(call, file, "text/csv; charset=utf-8", download_name(call, "responses.csv"));
}

void get_results(Call& call) {
  send_json(call.response, 200, export_at(call).results());
  tell_damage(call);
}

void get_export(Call& call) {
  auto exported = export_at(call);
  const TemporaryFile file(work_folder(call), ".zip");
  exported.write_archive(file.path(), work_folder(call), call.service.database.damage());
  send_download(call, file, "application/zip", download_name(call, "export.zip"));
}

void get_report(Call& call) {
  auto exported = export_at(call);
  call.response.status = 200;
  // One page without scripts: its style and its figures are in it.
  call.response.set_header("Content-Security-Policy",
                           "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; "
                           "form-action 'none'; frame-ancestors 'none'");
  call.response.set_content(study::html_report(exported.results(), exported.report_context()),
                            "text/html; charset=utf-8");
}

std::vector<study::Figure> figures_at(Call& call) {
  auto exported = export_at(call);
  auto options = exported.report_context().figures;
  options.width_mm = number_in_query(call.request, "width_mm", 40, 1000, 0);
  if (call.request.has_param("set")) {
    options.set = call.request.get_param_value("set");
    if (!exported.results().at("included_sets").contains(options.set))
      throw bad_value("set", "must be one of the results' included_sets");
  }
  return study::figures_of(exported.results(), options);
}

void list_figures(Call& call) {
  const std::string at = "/api/v1/studies/" + call.path.at("id") + "/figures/";
  auto list = json::array();
  for (const auto& figure : figures_at(call))
    list.push_back({{"name", figure.name},
                    {"title", figure.title},
                    {"scene", figure.scene.empty() ? json(nullptr) : json(figure.scene)},
                    {"url", at + figure.name + ".svg"}});
  send_json(call.response, 200, {{"figures", list}});
}

void get_figure(Call& call) {
  const std::string& file = call.path.at("figure");
  for (const auto& figure : figures_at(call)) {
    if (figure.name + ".svg" != file) continue;
    call.response.status = 200;
    call.response.set_content(figure.svg, "image/svg+xml");
    return;
  }
  throw nothing_here();
}

}  // namespace

StudyExport export_of(Service& service, std::shared_ptr<const FrozenStudy> frozen) {
  const auto counts = service.studies.counts(frozen->study.id, frozen->version);
  const auto pictures = service.studies.pictures(frozen->study.id, frozen->version);
  auto measures = measures_shown(*frozen, pictures);
  return {service.participants, std::move(frozen), static_cast<std::size_t>(counts.withdrawn),
          std::move(measures)};
}

void add_export_routes(std::vector<Route>& table) {
  const std::string one = "/api/v1/studies/{id}";
  table.push_back({"GET", one + "/responses.csv", Access::researcher, get_responses});
  table.push_back({"GET", one + "/results.json", Access::researcher, get_results});
  table.push_back({"GET", one + "/report.html", Access::researcher, get_report});
  table.push_back({"GET", one + "/figures", Access::researcher, list_figures});
  table.push_back({"GET", one + "/figures/{figure}", Access::researcher, get_figure});
  table.push_back({"GET", one + "/export.zip", Access::researcher, get_export});
}

}  // namespace penumbra::server::http
