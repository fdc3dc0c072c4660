// Pictures of the researcher's own that studies show: decoded by a process of its own and kept as
// pixels alone, under their SHA-256.
#include "server/http/own_pictures.h"

#include <map>

#include "server/http/body.h"
#include "server/http/png.h"
#include "server/http/reply.h"
#include "server/http/scene_upload.h"
#include "server/http/service.h"
#include "server/storage/folder_files.h"
#include "study/faults.h"
#include "study/study.h"

namespace penumbra::server::http {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Reads and keeps a picture: {"picture","width","height"}.
json store_picture(Service& service, const fs::path& file) {
  const auto picture =
      service.scene_reader.read_picture(file, [&] { return service.draining.load(); });
  return {{"picture", service.pictures.freeze(pixels_only(picture.png))},
          {"width", picture.width},
          {"height", picture.height}};
}

void post_picture(Call& call) {
  if (call.body.empty()) throw bad_value("body", "is empty; send a PNG, JPEG or WebP file");
  const Staging staging(call.service.folder.path());
  const auto file = staging.path / "picture";
  storage::write_file_durably(file, call.body);
  const auto stored = store_picture(call.service, file);
  call.response.set_header("Location",
                           "/api/v1/pictures/" + stored.at("picture").get<std::string>());
  send_json(call.response, 201, stored);
}

void get_own_picture(Call& call) {
  const auto& name = call.path.at("picture");
  const auto png =
      study::is_picture_name(name) ? call.service.pictures.read_stored(name) : std::nullopt;
  if (!png) throw nothing_here();
  call.response.status = 200;
  call.response.set_content(*png, "image/png");
}

/// The folder of the archive that study.json lies in.
fs::path study_folder(const fs::path& unpacked) {
  std::vector<fs::path> found;
  if (fs::is_regular_file(unpacked / "study.json")) found.push_back(unpacked);
  for (const auto& entry : fs::directory_iterator(unpacked))
    if (fs::is_regular_file(entry.path() / "study.json")) found.push_back(entry.path());
  if (found.size() != 1)
    throw unreadable("the archive must hold one study.json, not " + std::to_string(found.size()),
                     "body");
  return found.front();
}

/// Puts stored pictures in the place of files that a study names.
class FileNames {
 public:
  FileNames(Service& service_, const fs::path& folder_) : service(service_), folder(folder_) {}

  void replace_in(json& study) {
    list_in(study, "techniques");
    if (const auto practice = study.find("practice"); practice != study.end())
      list_in(*practice, "practice.techniques");
    const auto pages = study.find("pages");
    if (pages == study.end() || !pages->is_array()) return;
    for (std::size_t i = 0; i < pages->size(); ++i)
      list_in((*pages)[i], "pages[" + std::to_string(i) + "].techniques");
  }

  study::FaultList faults;

 private:
  /// What is no list of objects is named when the study is parsed.
  void list_in(json& owner, const std::string& path) {
    if (!owner.is_object() || !owner.contains("techniques")) return;
    auto& list = owner["techniques"];
    for (std::size_t i = 0; list.is_array() && i < list.size(); ++i) {
      if (!list[i].is_object() || !list[i].contains("picture")) continue;
      auto& name = list[i]["picture"];
      if (!name.is_string() || study::is_picture_name(name.get<std::string>())) continue;
      const auto field = path + "[" + std::to_string(i) + "].picture";
      try {
        name = stored(name.get<std::string>());
      } catch (const Error& error) {
        if (error.code != "not_found" && error.code != "unreadable" && error.code != "unsupported")
          throw;
        faults.add(bad_value(field, error.what()));
      }
    }
  }

  std::string stored(const std::string& name) {
    if (const auto found = known.find(name); found != known.end()) return found->second;
    const fs::path relative = fs::path(name).lexically_normal();
    const bool outside = relative.is_absolute() || relative.empty() || *relative.begin() == "..";
    if (outside || !fs::is_regular_file(folder / relative))
      throw not_found("picture", "the archive has no file " + name + " beside study.json");
    return known[name] = store_picture(service, folder / relative).at("picture");
  }

  Service& service;
  fs::path folder;
  std::map<std::string, std::string> known;  ///< SHA-256 by name
};

}  // namespace

json study_of_zip(Service& service, const std::string& zip) {
  const Staging staging(service.folder.path());
  unpack(zip, staging.path);
  const auto folder = study_folder(staging.path);
  if (fs::file_size(folder / "study.json") > largest_study)
    throw Error("too_large", "study.json has more than " + std::to_string(largest_study) + " bytes",
                "body");
  auto study = parse_json(storage::read_file(folder / "study.json"));
  FileNames names(service, folder);
  names.replace_in(study);
  names.faults.throw_if_any();
  return study;
}

void add_picture_routes(std::vector<Route>& table) {
  table.push_back({"POST", "/api/v1/pictures", Access::researcher, post_picture, largest_upload});
  table.push_back({"GET", "/api/v1/pictures/{picture}", Access::researcher, get_own_picture});
}

}  // namespace penumbra::server::http
