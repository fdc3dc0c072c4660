#include <filesystem>
#include <memory>
#include <sstream>

#include "experiments/engine/progress_file.h"
#include "experiments/stability/report.h"
#include "server/cli/progress.h"
#include "server/cli/session.h"
#include "server/cli/table.h"
#include "server/jobs/drawing_version.h"

namespace penumbra::server::cli {
namespace {

namespace stability = experiments::stability;
using nlohmann::json;

json document_of(const stability::Report& report, const std::string& out) {
  json findings = json::array();
  for (const stability::Finding& finding : report.findings) {
    const stability::Reason* reason = stability::reason_of(finding.technique, finding.axis);
    findings.push_back(
        {{"technique", finding.technique},
         {"axis", finding.axis},
         {"holds", finding.holds ? json(*finding.holds) : json()},
         {"ends", finding.ends ? json(*finding.ends) : json()},
         {"refused", finding.refused},
         {"cause", finding.cause},
         {"guard", finding.guard},
         {"required", finding.ends && reason != nullptr ? json(reason->required) : json()}});
  }
  return {{"device", {{"name", report.device}, {"driver", report.driver}}},
          {"steps", report.steps},
          {"drawn", report.drawn},
          {"findings", findings},
          {"links", {{"report", out + "/report.html"}, {"csv", out + "/results.csv"}}}};
}

/// Axes take different times, so shares of the whole are told as such.
std::size_t percent(double share) {
  return static_cast<std::size_t>(100.0 * share);
}

std::string text_of(const stability::Report& report, const std::string& out) {
  Table table({"technique", "axis", "holds to", "first that does not", "what happens"});
  std::size_t holding = 0;
  for (const stability::Finding& finding : report.findings) {
    if (!finding.ends) {
      ++holding;
      continue;
    }
    const stability::Axis axis = stability::find_axis(finding.technique, finding.axis);
    table.add({finding.technique, finding.axis, finding.holds ? axis.text(*finding.holds) : "-",
               axis.text(*finding.ends), finding.cause.substr(0, 60)});
  }
  std::ostringstream text;
  text << table.text(true) << holding << " of " << report.findings.size()
       << " hold to the end of their axis; " << report.steps << " steps, " << report.drawn
       << " drawn now\nwrote " << out << "/report.html\n";
  return text.str();
}

}  // namespace

void add_stability_command(CLI::App& app, Session& session) {
  auto options = std::make_shared<stability::Options>();
  CLI::App* command =
      app.add_subcommand("stability", "Where techniques break, from gentle to absurd");
  command->add_option("--techniques", options->techniques, "Ids or presets [every technique]")
      ->delimiter(',');
  command->add_option("--axes", options->axes, "Axes [all]")->delimiter(',');
  command
      ->add_option("--out", options->out, "Folder of results; a run that was ended goes on there")
      ->required();
  command->add_option("--processes", options->processes, "Processes that draw")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--device", options->device, "Vulkan device: part of its name, or its index");
  add_json_flag(*command, session);
  command->callback([options, &session] {
    session.action = [options, &session] {
      options->version = drawing_version();
      stability::Report report;
      {
        Progress progress("stability");
        experiments::ProgressFile file(options->out);
        options->progress = [&](double value, const std::string& what) {
          progress.show(value, what);
          file.show({percent(value), 100, 0, std::nullopt, what});
        };
        report = stability::run(*options);
        file.show({percent(1.0), 100, report.drawn, std::nullopt, ""});
      }
      stability::write_report(report, options->out);
      const std::string out = options->out.string();
      session.print(document_of(report, out), text_of(report, out));
      return 0;
    };
  });
}

}  // namespace penumbra::server::cli
