#include "server/jobs/request_scene.h"

#include <algorithm>
#include <list>
#include <mutex>
#include <set>

#include "renderer/error.h"
#include "scenes/library.h"

namespace penumbra::server {
namespace fs = std::filesystem;
namespace {

/// Scenes kept: the survey's six, a study's own few, and what a person tries beside them.
constexpr std::size_t kept_scenes = 16;

bool is_generated(const std::string& name) {
  static const std::set<std::string> ids = [] {
    std::set<std::string> list;
    for (const scenes::SceneInfo& info : scenes::built_in()) list.insert(info.id);
    return list;
  }();
  return ids.contains(name) || name.starts_with("sweep:");
}

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

struct Kept {
  std::string key;
  std::string stamp;
  HashedScene scene;
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
  throw not_found("scene", "there is no scene \"" + name + "\"; there are " + known +
                               "and sweep:OBJECTSxTRIANGLESxLIGHTS");
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

HashedScene load_request_scene(const std::string& name, const RequestContext& context) {
  const bool generated = is_generated(name);
  const bool path_like = name.find_first_of(std::string_view("/\\\0", 3)) != std::string::npos ||
                         name.starts_with(".");
  const std::string stamp = generated || path_like ? "" : stamp_of(name, context.data);
  if (!generated && stamp.empty()) {
    if (!context.files) refuse(name, context.data);
    return load_now(name, context.data);
  }

  static std::mutex mutex;
  static std::list<Kept> kept;  // most recently used first
  const std::string key = generated ? name : context.data.string() + "/" + name;
  {
    const std::lock_guard lock(mutex);
    const auto found =
        std::find_if(kept.begin(), kept.end(), [&](const Kept& k) { return k.key == key; });
    if (found != kept.end() && found->stamp == stamp) {
      kept.splice(kept.begin(), kept, found);
      return found->scene;
    }
  }
  const HashedScene loaded = load_now(name, context.data);
  const std::lock_guard lock(mutex);
  kept.remove_if([&](const Kept& k) { return k.key == key; });
  kept.push_front({key, stamp, loaded});
  if (kept.size() > kept_scenes) kept.pop_back();
  return loaded;
}

}  // namespace penumbra::server
