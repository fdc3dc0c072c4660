#include <httplib.h>
#include <openssl/crypto.h>
#include <sqlite3.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "renderer/error.h"
#include "renderer/render.h"
#include "scenes/formats/picture_formats.h"
#include "server/cli/local_renders.h"
#include "server/cli/session.h"
#include "server/jobs/device_lock.h"
#include "server/jobs/drawing_version.h"
#include "techniques/registry.h"

namespace penumbra::server::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// A question about this machine, and its answer in words.
struct Check {
  std::string name;
  bool fine = false;
  std::string found;
};

std::string vulkan_version(std::uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
         std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

json libraries() {
  std::uint32_t loader = VK_API_VERSION_1_0;
  vkEnumerateInstanceVersion(&loader);
  return {{"penumbra", PENUMBRA_VERSION},
          {"renderer", drawing_version()},
          {"vulkan_loader", vulkan_version(loader)},
          {"sqlite", sqlite3_libversion()},
          {"openssl", OpenSSL_version(OPENSSL_VERSION)},
          {"cpp_httplib", CPPHTTPLIB_VERSION}};
}

/// Empty where no driver is found: check_drawing says so.
json devices_found() {
  json devices = json::array();
  try {
    for (const DeviceInfo& info : list_devices())
      devices.push_back({{"index", info.index},
                         {"name", info.name},
                         {"driver", info.driver},
                         {"type", info.type}});
  } catch (const Error&) {
  }
  return devices;
}

/// EXR, TIFF and what else is read and written by a library that is loaded when first needed.
Check check_formats() {
  try {
    return {"picture formats", true, "OpenImageIO " + scenes::picture_formats().version()};
  } catch (const Error& error) {
    return {"picture formats", false, error.what()};
  }
}

json layers() {
  std::uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> list(count);
  vkEnumerateInstanceLayerProperties(&count, list.data());
  json names = json::array();
  for (const VkLayerProperties& layer : list) names.push_back(layer.layerName);
  return names;
}

Check check_folder(const std::string& name, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || ::access(folder.c_str(), W_OK) != 0)
    return {name, false, folder.string() + " cannot be written to"};
  const auto space = fs::space(folder, error);
  return {name, true, folder.string() + ", " + std::to_string(space.available >> 20) + " MiB free"};
}

Check check_drawing(const std::string& device, bool validation) {
  try {
    Renderer renderer(RendererOptions{device, validation});
    return {"drawing", true, "opens " + renderer.device().name};
  } catch (const std::exception& error) {
    return {"drawing", false, error.what()};
  }
}

Check check_validation(const json& names) {
  for (const json& name : names)
    if (name == "VK_LAYER_KHRONOS_validation") return {"validation layer", true, "installed"};
  return {"validation layer", false, "not installed (package vulkan-validationlayers)"};
}

int examine(const Session& session, const std::string& device, const fs::path& data) {
  const json devices = devices_found();
  const json names = layers();
  std::vector<Check> checks{check_drawing(device, false), check_folder("data folder", data),
                            check_formats(), check_folder("cache folder", cache_folder())};
  const bool works = checks[0].fine && checks[1].fine && checks[2].fine;
  checks.push_back(check_validation(names));  // good to have, needed by tests only
  checks.push_back({"techniques", !techniques::all().empty(),
                    std::to_string(techniques::all().size()) + " and " +
                        std::to_string(techniques::presets().size()) + " presets"});

  json list = json::array();
  std::ostringstream text;
  for (const json& info : devices)
    text << "device " << info.at("index") << ": " << info.at("name").get<std::string>() << " ("
         << info.at("type").get<std::string>() << ", " << info.at("driver").get<std::string>()
         << ")\n";
  for (const Check& check : checks) {
    list.push_back({{"name", check.name}, {"fine", check.fine}, {"found", check.found}});
    text << (check.fine ? "fine  " : "LACKS ") << check.name << ": " << check.found << "\n";
  }
  const json versions = libraries();
  for (const auto& [name, version] : versions.items())
    text << name << " " << version.get<std::string>() << "\n";
  session.print({{"works", works},
                 {"devices", devices},
                 {"checks", list},
                 {"layers", names},
                 {"versions", versions},
                 {"device_lock", DeviceLock::path().string()}},
                text.str());
  return works ? 0 : 1;
}

}  // namespace

void add_doctor_command(CLI::App& app, Session& session) {
  struct Options {
    std::string device;
    fs::path data = "data";
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("doctor", "Tell what this machine offers and what is missing");
  command->add_option("--device", options->device, "Vulkan device: part of its name, or its index");
  command->add_option("--data", options->data, "Folder of everything the server keeps")
      ->capture_default_str();
  add_json_flag(*command, session);
  command->callback([options, &session] {
    session.action = [options, &session] {
      return examine(session, options->device, options->data);
    };
  });
}

}  // namespace penumbra::server::cli
