#include "server/jobs/request_scene.h"

#include <algorithm>
#include <chrono>
#include <list>
#include <mutex>
#include <optional>
#include <semaphore>

#include "renderer/error.h"
#include "scenes/library.h"
#include "server/files/durable_file.h"

namespace penumbra::server {
namespace fs = std::filesystem;
namespace {

/// Scenes that are read or generated at once, and how long others wait for their turn. Each may
/// take seconds and a gigabyte.
constexpr int most_at_once = 2;
constexpr auto patience = std::chrono::seconds(20);

/// An imported scene is a folder data/scenes/<id>, or a file of that stem.
std::string id_of(const fs::directory_entry& entry) {
  return entry.is_directory() ? entry.path().filename().string() : entry.path().stem().string();
}

/// Changes whenever an imported scene's files do; empty where there is no such scene.
std::string stamp_of(const std::string& id, const fs::path& data) {
  if (data.empty() || !fs::is_directory(data / "scenes")) return {};
  std::string stamp;
  const auto add = [&stamp](const fs::directory_entry& entry) {
    std::error_code error;
    const auto time = entry.last_write_time(error).time_since_epoch().count();
    stamp += entry.path().filename().string() + "@" + std::to_string(time) + ";";
  };
  for (const fs::directory_entry& entry : fs::directory_iterator(data / "scenes")) {
    if (id_of(entry) != id) continue;
    add(entry);
    if (entry.is_directory())
      for (const fs::directory_entry& inner : fs::recursive_directory_iterator(entry.path()))
        add(inner);
  }
  return stamp;
}

/// About what a scene takes in memory.
std::uint64_t bytes_of(const Scene& scene) {
  const auto size = [](const auto& list) {
    return list.capacity() * sizeof(typename std::decay_t<decltype(list)>::value_type);
  };
  std::uint64_t bytes = size(scene.instances) + size(scene.lights);
  for (const Mesh& mesh : scene.meshes)
    bytes += size(mesh.positions) + size(mesh.normals) + size(mesh.uvs) + size(mesh.colors) +
             size(mesh.indices) + size(mesh.primitives);
  for (const Texture& texture : scene.textures) bytes += size(texture.rgba);
  return bytes;
}

/// Loaded scenes, most recently used first.
class Shelf {
 public:
  std::optional<HashedScene> find(const std::string& key, const std::string& stamp) {
    const std::lock_guard lock(mutex_);
    const auto found =
        std::find_if(kept_.begin(), kept_.end(), [&](const Kept& each) { return each.key == key; });
    if (found == kept_.end() || found->stamp != stamp) return {};
    kept_.splice(kept_.begin(), kept_, found);
    return found->scene;
  }

  void add(const std::string& key, const std::string& stamp, const HashedScene& scene,
           std::uint64_t most_bytes) {
    const std::uint64_t bytes = bytes_of(*scene.scene);
    const std::lock_guard lock(mutex_);
    kept_.remove_if([&](const Kept& each) { return each.key == key; });
    if (bytes <= most_bytes) kept_.push_front({key, stamp, scene, bytes});
    std::uint64_t sum = 0;
    for (auto each = kept_.begin(); each != kept_.end();) {
      sum += each->bytes;
      each = sum > most_bytes ? kept_.erase(each) : std::next(each);
    }
  }

 private:
  struct Kept {
    std::string key;
    std::string stamp;
    HashedScene scene;
    std::uint64_t bytes;
  };
  std::mutex mutex_;
  std::list<Kept> kept_;
};

HashedScene load_now(const std::string& name, const fs::path& data) {
  HashedScene loaded;
  loaded.scene = scenes::load(name, data);
  loaded.hash = scenes::content_hash(*loaded.scene);
  return loaded;
}

[[noreturn]] void refuse(const std::string& name, const fs::path& data) {
  std::string known;
  for (const scenes::SceneInfo& info : scenes::built_in()) known += info.id + ", ";
  for (const std::string& id : imported_scenes(data)) known += id + ", ";
  throw not_found("scene", "there is no scene \"" + name + "\"; there are " + known + "and " +
                               scenes::generated_forms());
}

}  // namespace

std::vector<std::string> imported_scenes(const fs::path& data) {
  std::vector<std::string> ids;
  if (data.empty() || !fs::is_directory(data / "scenes")) return ids;
  for (const fs::directory_entry& entry : fs::directory_iterator(data / "scenes")) {
    const std::string id = id_of(entry);
    if (!id.empty() && id.front() != '.') ids.push_back(id);
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

nlohmann::json about_imported_scene(const fs::path& data, const std::string& id) {
  nlohmann::json about = {{"title", id}, {"notes", nlohmann::json::array()}};
  const auto text = read_whole(data / "scenes" / id / about_scene_file);
  if (!text) return about;
  const nlohmann::json kept = nlohmann::json::parse(*text, nullptr, false);
  if (!kept.is_object()) return about;
  if (const auto title = kept.find("title");
      title != kept.end() && title->is_string() && !title->get_ref<const std::string&>().empty())
    about["title"] = *title;
  if (const auto notes = kept.find("notes"); notes != kept.end() && notes->is_array())
    about["notes"] = *notes;
  return about;
}

HashedScene load_request_scene(const std::string& name, const RequestContext& context) {
  const bool generated = scenes::is_generated(name);
  const bool path_like = name.find_first_of(std::string_view("/\\\0", 3)) != std::string::npos ||
                         name.starts_with(".");
  const std::string stamp = generated || path_like ? "" : stamp_of(name, context.data);
  if (!generated && stamp.empty()) {
    if (!context.files) refuse(name, context.data);
    return load_now(name, context.data);
  }

  static Shelf shelf;
  static std::counting_semaphore<most_at_once> places{most_at_once};
  const std::string key = generated ? name : context.data.string() + "/" + name;
  if (const auto found = shelf.find(key, stamp)) return *found;
  if (!places.try_acquire_for(patience)) throw Error("busy", "other scenes are being loaded");
  struct Place {
    ~Place() { places.release(); }
  } const place;
  // Another may have loaded it meanwhile.
  if (const auto found = shelf.find(key, stamp)) return *found;
  const HashedScene loaded = load_now(name, context.data);
  shelf.add(key, stamp, loaded, context.kept_scene_bytes);
  return loaded;
}

}  // namespace penumbra::server
