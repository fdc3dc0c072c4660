#include "server/cli/request_options.h"

#include <fstream>
#include <sstream>
#include <utility>

#include "renderer/error.h"
#include "scenes/document.h"
#include "scenes/library.h"

namespace penumbra::server::cli {
namespace {

std::pair<std::string, std::string> split(const std::string& flag, const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || sign == 0)
    throw bad_value(flag, "--" + flag + " takes name=value, not \"" + text + "\"");
  return {text.substr(0, sign), text.substr(sign + 1)};
}

nlohmann::json camera_path_in(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!(text << stream.rdbuf()))
    throw bad_value("camera_path", "--camera-path: cannot read " + file.string());
  try {
    return scenes::parse_json(text.str(), file.string());
  } catch (const Error& error) {
    throw bad_value("camera_path", error.what());
  }
}

}  // namespace

void RequestOptions::add_to(CLI::App& command) {
  const RenderRequest defaults;
  command.add_option("SCENE", scene, scenes::ways_to_name_a_scene())->required();
  command.add_option("TECHNIQUE", technique, "Id of a technique or preset")->required();
  command.add_option("--set", sets, "Parameter of the technique, name=value; may be repeated")
      ->allow_extra_args(false);
  command.add_option("--light", lights, "Key of a light, NAME.key=value; may be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--camera-set", camera_sets, "Key of a camera, NAME.key=value; may be repeated")
      ->allow_extra_args(false);
  command.add_option("--camera-path", camera_path,
                     "JSON file: list of cameras that are drawn in order; the last is the picture");
  const auto key = [&](const std::string& flag, const std::string& name,
                       const std::string& meaning) {
    command.add_option_function<std::string>(
        "--" + flag, [this, name](const std::string& value) { keys[name] = value; }, meaning);
  };
  const auto with_default = [](const std::string& meaning, std::uint64_t value) {
    return meaning + " [" + std::to_string(value) + "]";
  };
  key("width", "width", with_default("Pixels", defaults.width));
  key("height", "height", with_default("Pixels", defaults.height));
  key("camera", "camera", "Name of a camera; by default the scene's first");
  std::string choices;
  for (const auto choice : RenderLimits::supersampling)
    choices += (choices.empty() ? "" : ", ") + std::to_string(choice);
  key("supersampling", "supersampling",
      with_default("Samples per pixel: " + choices, defaults.supersampling));
  key("light-samples", "light_samples",
      with_default("Rays per pixel and light, of techniques that take many",
                   defaults.light_samples));
  key("error-bound", "error_bound",
      "Of the reference: stop once its own error is no more than this, levels of 0..255 "
      "[no bound]");
  key("exposure", "exposure",
      "EV: linear light is multiplied by 2^EV before encoding [what the scene has]");
  key("seed", "seed", with_default("Of everything random", defaults.seed));
  command.add_option("--data", data, "Folder of imported scenes");
  command.add_option("--device", device, "Vulkan device: part of its name, or its index");
  command.add_flag("--validation", validation, "Turn Vulkan's validation layer on");
}

CanonicalRequest RequestOptions::read(bool measure) const {
  std::vector<std::pair<std::string, std::string>> entries{{"scene", scene},
                                                           {"technique", technique}};
  entries.insert(entries.end(), keys.begin(), keys.end());
  nlohmann::json request = request_from_text(entries);
  // --set names parameters only: it must not reach the keys of the request.
  for (const std::string& text : sets) {
    const auto [name, value] = split("set", text);
    if (request["parameters"].contains(name))
      throw bad_value(name, "--set " + name + " is given twice");
    request["parameters"][name] = value;
  }
  for (const std::string& text : lights) {
    const auto [path, value] = split("light", text);
    add_override(request, Changed::light, path, value);
  }
  for (const std::string& text : camera_sets) {
    const auto [path, value] = split("camera-set", text);
    add_override(request, Changed::camera, path, value);
  }
  if (!camera_path.empty()) request["camera_path"] = camera_path_in(camera_path);
  request["measure"] = measure;
  return read_request(request, context());
}

}  // namespace penumbra::server::cli
