#include <cmath>

#include "renderer/error.h"
#include "renderer/metrics/metrics.h"
#include "scenes/measured_picture.h"
#include "server/cli/session.h"
#include "server/cli/table.h"

namespace penumbra::server::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

int compare(const Session& session, const fs::path& a, const fs::path& b) {
  const scenes::MeasuredPicture first = scenes::read_measured_picture(a);
  const scenes::MeasuredPicture second = scenes::read_measured_picture(b);
  const ImageF& picture = first.levels;
  const ImageF& reference = second.levels;
  if (picture.width != reference.width || picture.height != reference.height)
    throw bad_value("B", a.string() + " has " + std::to_string(picture.width) + " x " +
                             std::to_string(picture.height) + " pixels, " + b.string() + " has " +
                             std::to_string(reference.width) + " x " +
                             std::to_string(reference.height));
  const double ratio = metrics::psnr(picture, reference);
  json document{{"rms_y", metrics::rms_y(picture, reference)},
                {"psnr", std::isfinite(ratio) ? json(ratio) : json(nullptr)},
                {"ssim", nullptr},
                {"flip", metrics::flip(picture, reference)},
                {"notes", json::array()}};
  for (const auto& [read, file] : {std::pair(&first, &a), std::pair(&second, &b)})
    for (const std::string& note : read->notes)
      document["notes"].push_back(file->string() + " " + note);
  try {
    document["ssim"] = metrics::ssim(picture, reference);
  } catch (const Error& error) {
    document["notes"].push_back(std::string("no ssim: ") + error.what());
  }
  if (!std::isfinite(ratio))
    document["notes"].push_back("the pictures are equal: psnr is infinite, which JSON cannot say");

  Table table{{"measure", "value"}};
  for (const char* name : {"rms_y", "psnr", "ssim", "flip"})
    table.add({name, number(document[name], 4)});
  std::string text = table.text();
  for (const json& note : document["notes"]) text += "note: " + note.get<std::string>() + "\n";
  session.print(document, text);
  return 0;
}

}  // namespace

void add_compare_command(CLI::App& app, Session& session) {
  struct Options {
    fs::path a;
    fs::path b;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("compare", "Measure how far two pictures are apart");
  command->add_option("A", options->a, "Picture")->required()->check(CLI::ExistingFile);
  command->add_option("B", options->b, "What it is compared with")
      ->required()
      ->check(CLI::ExistingFile);
  add_json_flag(*command, session);
  command->callback([options, &session] {
    session.action = [options, &session] { return compare(session, options->a, options->b); };
  });
}

}  // namespace penumbra::server::cli
