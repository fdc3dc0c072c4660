#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <thread>

#include "renderer/embedded_file.h"
#include "renderer/error.h"
#include "server/cli/progress.h"
#include "server/cli/session.h"
#include "server/cli/table.h"
#include "server/files/durable_file.h"
#include "server/http/documents.h"
#include "server/jobs/render_service.h"
#include "study/study.h"
#include "techniques/registry.h"

namespace penumbra::server::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct DemoOptions {
  fs::path study;
  RenderServiceOptions service;
  fs::path pictures;
};

struct Cell {
  std::string page;
  std::string picture;
  std::string label;
  std::string id;
  json cost;
  json quality;
};

study::Study read_study(const fs::path& file) {
  if (file.empty()) return study::parse_study(std::string(http::embedded_studies().front().text));
  const auto text = read_whole(file);
  if (!text) throw unreadable("cannot read " + file.string(), "study");
  return study::parse_study(*text);
}

/// Every picture of a study, page by page, and what to ask the service for.
struct Plan {
  std::vector<Cell> cells;
  std::vector<json> requests;
  std::vector<std::size_t> order;  ///< in which they are drawn
};

/// Drawn in the order in which they are worth looking at: first every scene as it really is, then
/// technique by technique, so that breaking off leaves whole rows of the table.
Plan plan_of(const study::Study& study) {
  Plan plan;
  std::vector<std::pair<bool, std::size_t>> place;  ///< no truth; place on its page
  for (const study::Page& page : study.pages) {
    const study::PageRenders renders = study::page_renders(study, page);
    for (std::size_t i = 0; i < page.pictures.size(); ++i) {
      plan.order.push_back(plan.cells.size());
      plan.cells.push_back({page.id, page.pictures[i].id, page.pictures[i].label, {}, {}, {}});
      plan.requests.push_back(renders.pictures[i].at(study::first_view(page)));
      plan.requests.back()["measure"] = true;
      const std::string technique = plan.requests.back().at("technique");
      place.emplace_back(techniques::resolve(technique).technique->family != "truth", i);
    }
  }
  std::stable_sort(plan.order.begin(), plan.order.end(),
                   [&](std::size_t a, std::size_t b) { return place[a] < place[b]; });
  return plan;
}

RenderRecord draw(const json& request, const Cell& cell, RenderService& service, double deadline_s,
                  const std::function<void(double)>& show) {
  RenderRecord record = service.submit(request);
  while (record.status == "queued" || record.status == "running") {
    show(record.progress);
    record = service.wait_change(record.id, record, deadline_s).value_or(record);
  }
  if (record.status != "done")
    throw Error(record.error.is_null() ? "internal" : record.error.value("code", "internal"),
                cell.page + ", " + cell.picture + ": " +
                    (record.error.is_null() ? record.status : record.error.value("message", "")));
  return record;
}

/// Copies of a picture and of its error map under names for people. Returns the picture's path.
fs::path write_pictures(const Cell& cell, RenderService& service, const fs::path& folder) {
  const auto path = [&](const std::string& suffix) {
    return folder / (cell.page + "-" + cell.picture + suffix + ".png");
  };
  for (const auto& [artefact, suffix] :
       std::map<std::string, std::string>{{"image.png", ""}, {"error.png", "-error"}})
    if (const auto bytes = service.artefact(cell.id, artefact))
      write_durably(path(suffix), folder / ".new", *bytes);
  return path("");
}

/// Asks for every picture, one after the other: each is measured while nothing else draws. Each
/// lies in `folder` as soon as it is drawn.
std::vector<Cell> draw_all(const study::Study& study, RenderService& service, double deadline_s,
                           const fs::path& folder) {
  Plan plan = plan_of(study);
  fs::create_directories(folder);
  Progress progress("pictures of " + study.id);
  for (std::size_t i = 0; i < plan.order.size(); ++i) {
    Cell& cell = plan.cells[plan.order[i]];
    const auto show = [&](double part) {
      progress.show((static_cast<double>(i) + part) / static_cast<double>(plan.order.size()),
                    cell.page + ", " + cell.picture);
    };
    const RenderRecord record = draw(plan.requests[plan.order[i]], cell, service, deadline_s, show);
    cell.id = record.id;
    cell.cost = record.cost;
    cell.quality = record.quality;
    const fs::path picture = write_pictures(cell, service, folder);
    if (i == 0) progress.note("the first picture: " + picture.string());
  }
  return plan.cells;
}

std::string table_of(const std::vector<Cell>& cells,
                     const std::function<std::string(const Cell&)>& value) {
  std::vector<std::string> pages;
  std::vector<std::string> pictures;
  std::map<std::pair<std::string, std::string>, std::string> values;
  std::map<std::string, std::string> labels;
  const auto add_once = [](std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  for (const Cell& cell : cells) {
    add_once(pages, cell.page);
    add_once(pictures, cell.picture);
    values[{cell.page, cell.picture}] = value(cell);
    labels[cell.picture] = cell.label;
  }
  std::vector<std::string> header{"technique"};
  header.insert(header.end(), pages.begin(), pages.end());
  Table table(header);
  for (const std::string& picture : pictures) {
    std::vector<std::string> row{
        picture == labels[picture] ? picture : picture + " (" + labels[picture] + ")"};
    for (const std::string& page : pages) {
      const auto found = values.find({page, picture});
      row.push_back(found == values.end() ? "-" : found->second);
    }
    table.add(row);
  }
  return table.text();
}

int demonstrate(const Session& session, const DemoOptions& options) {
  const study::Study study = read_study(options.study);
  const auto service = make_render_service(options.service);
  const fs::path folder =
      options.pictures.empty() ? options.service.data / "demonstration" : options.pictures;
  const std::vector<Cell> cells = draw_all(study, *service, options.service.deadline_s, folder);
  const json device = service->statistics().at("device");
  service->drain(0.0);

  json list = json::array();
  for (const Cell& cell : cells)
    list.push_back({{"scene", cell.page},
                    {"picture", cell.picture},
                    {"id", cell.id},
                    {"cost", cell.cost},
                    {"quality", cell.quality}});
  const std::string text =
      "rms_y: error against the converged reference, 0..255\n" +
      table_of(cells, [](const Cell& c) { return number(c.quality.at("rms_y"), 2); }) +
      "\nms per frame on " + device.value("name", "this device") + "\n" +
      table_of(cells, [](const Cell& c) { return number(c.cost.at("frame_ms").at("median"), 1); }) +
      "\npictures and error maps: " + folder.string() + "\n";
  session.print(
      {{"study", study.id}, {"device", device}, {"pictures", list}, {"folder", folder.string()}},
      text);
  return 0;
}

}  // namespace

void add_demo_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<DemoOptions>();
  options->service.data = "data";
  CLI::App* command =
      app.add_subcommand("demo", "Draw and measure the pictures of a study, print the error table");
  command->add_option("--study", options->study, "Study file; by default the one that ships")
      ->check(CLI::ExistingFile);
  command->add_option("--data", options->service.data, "Folder of everything the server keeps")
      ->capture_default_str();
  command->add_option("--device", options->service.device,
                      "Vulkan device: part of its name, or its index");
  command->add_option("--pictures", options->pictures,
                      "Folder for the pictures; by default demonstration in the data folder");
  add_json_flag(*command, session);
  command->callback([options, &session] {
    session.action = [options, &session] { return demonstrate(session, *options); };
  });
}

}  // namespace penumbra::server::cli
