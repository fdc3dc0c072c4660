#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>

#include "renderer/error.h"
#include "scenes/picture_io.h"
#include "server/cli/local_renders.h"
#include "server/cli/progress.h"
#include "server/cli/request_options.h"
#include "server/cli/session.h"
#include "server/cli/table.h"
#include "server/cli/written_file.h"
#include "techniques/parameter_schema.h"

namespace penumbra::server::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct RenderOptions {
  RequestOptions request;
  fs::path out;
  fs::path visibility;
  fs::path error;
};

/// Formats of --out, and the file of a render that each is made of.
const std::map<std::string, const char*>& out_formats() {
  static const std::map<std::string, const char*> formats{
      {".png", want::image}, {".exr", want::linear}, {".jpg", want::image}, {".tif", want::image}};
  return formats;
}

void check_extension(const fs::path& path, const std::string& flag,
                     const std::vector<std::string>& allowed) {
  if (path.empty()) return;
  std::string list;
  for (const std::string& extension : allowed) {
    if (path.extension() == extension) return;
    list += (list.empty() ? "" : ", ") + extension;
  }
  throw bad_value(flag, "--" + flag + " " + path.string() + ": the name must end in " + list);
}

void check_out(const fs::path& path, const std::string& diagnostic) {
  std::vector<std::string> allowed;
  for (const auto& [extension, file] : out_formats())
    if (diagnostic.empty() || file != want::linear) allowed.push_back(extension);
  check_extension(path, "out", allowed);
}

std::set<std::string> wanted_files(const RenderOptions& options) {
  std::set<std::string> wants;
  if (!options.out.empty()) wants.insert(out_formats().at(options.out.extension()));
  if (!options.visibility.empty()) wants.insert(want::visibility);
  if (!options.error.empty()) wants.insert(want::error_map);
  return wants;
}

json write_files(const RenderOptions& options, const Blobs& artefacts) {
  json links = json::object();
  if (!options.out.empty()) {
    const std::string& bytes = artefacts.at(out_formats().at(options.out.extension()));
    if (options.out.extension() == ".png" || options.out.extension() == ".exr") {
      write_file(options.out, bytes);
    } else {
      scenes::write_picture(options.out, scenes::decode_picture(bytes));
    }
    links["out"] = options.out.string();
  }
  if (!options.visibility.empty()) {
    write_file(options.visibility, artefacts.at(want::visibility));
    links["visibility"] = options.visibility.string();
  }
  if (!options.error.empty()) {
    write_file(options.error, artefacts.at(want::error_map));
    links["error"] = options.error.string();
  }
  return links;
}

std::string cost_text(const json& cost) {
  if (cost.is_null()) return {};
  const json& frame = cost.at("frame_ms");
  std::ostringstream text;
  text << "frame        " << number(frame.at("median"), 3) << " ms median, "
       << number(frame.at("p95"), 3) << " ms p95, spread "
       << number(100.0 * frame.at("spread").get<double>(), 1) << "%, over "
       << frame.at("frames").get<int>() << " frames"
       << (frame.at("settled").get<bool>() ? "" : ", NOT SETTLED") << "\n"
       << "none         " << number(frame.at("none_median"), 3) << " ms, of which it is "
       << number(frame.at("over_none"), 2) << " times\n"
       << "create       " << number(cost.at("create_ms"), 1) << " ms\n"
       << "memory       " << cost.at("memory").at("over_none_bytes").get<std::uint64_t>()
       << " bytes over none\n";
  Table table{{"pass", "ms", "vertices", "primitives", "fragments", "compute"}};
  for (const json& pass : cost.at("passes"))
    table.add({pass.at("name").get<std::string>(), number(pass.at("median_ms"), 3),
               pass.at("vertices").dump(), pass.at("primitives").dump(),
               pass.at("fragment_invocations").dump(), pass.at("compute_invocations").dump()});
  return text.str() + table.text();
}

std::string quality_text(const json& quality) {
  if (quality.is_null()) return {};
  Table table{{"error against the reference", ""}};
  for (const auto& [name, value] : quality.items())
    if (value.is_number()) table.add({name, number(value, 4)});
  return table.text();
}

std::string people_text(const RenderRecord& record, const json& links) {
  std::string text = record.request.at("scene").get<std::string>() + ", " +
                     record.request.at("technique").get<std::string>() + ", " +
                     record.request.at("width").dump() + " x " +
                     record.request.at("height").dump() + " on " +
                     record.device.at("name").get<std::string>() + "\n";
  text += cost_text(record.cost) + quality_text(record.quality);
  for (const std::string& note : record.notes) text += "note: " + note + "\n";
  for (const auto& [name, path] : links.items()) text += "wrote " + path.get<std::string>() + "\n";
  return text;
}

int draw(const Session& session, RenderOptions options, bool measure) {
  check_out(options.out, options.request.text("diagnostic"));
  check_extension(options.visibility, "visibility", {".exr"});
  check_extension(options.error, "error", {".png"});
  const CanonicalRequest request = options.request.read(measure);
  if (!measure && !session.json && wanted_files(options).empty())
    options.out = options.request.text("technique") + ".png";

  std::set<std::string> wants = wanted_files(options);
  if (measure) wants.insert({want::cost, want::quality});
  LocalRenders renders(options.request.context(), options.request.validation);
  LocalRenders::Outcome outcome;
  {
    Progress progress("drawing");
    outcome = renders.render(request, wants, [&](double value) { progress.show(value); });
  }
  const json links = write_files(options, outcome.artefacts);
  json document = record_body(outcome.record);
  document["links"] = links;
  session.print(document, people_text(outcome.record, links));
  return 0;
}

void add(CLI::App& app, Session& session, const std::string& name, const std::string& meaning,
         bool measure) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand(name, meaning);
  options->request.add_to(*command,
                          measure ? requests::Commands::measure : requests::Commands::render);
  command->add_option("--out", options->out, "Picture: .png, .jpg, .tif, or .exr in linear light");
  command->add_option("--visibility", options->visibility, "A channel per light, .exr");
  command->add_option("--error", options->error, "Signed error against the reference, .png");
  add_json_flag(*command, session);
  command->callback([options, &session, measure] {
    session.action = [options, &session, measure] { return draw(session, *options, measure); };
  });
}

}  // namespace

void add_render_commands(CLI::App& app, Session& session) {
  add(app, session, "render", "Draw one picture", false);
  add(app, session, "measure", "Measure cost and the error against the reference", true);
}

}  // namespace penumbra::server::cli
