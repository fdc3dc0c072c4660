#pragma once

#include <memory>
#include <string>

#include "server/jobs/canonical_request.h"

namespace penumbra::server {

struct HashedScene {
  std::shared_ptr<const Scene> scene;
  std::string hash;  ///< scenes::content_hash
};

/// Loads the scene a request names, as the context permits. Scenes with an id are kept in memory,
/// as many as the context has bytes for, until what they were read from changes; files named by
/// path are read each time. Thread-safe; few are loaded at once, and `busy` is thrown where that
/// lasts. Throws not_found where the context does not permit paths and there is no scene of that
/// id.
HashedScene load_request_scene(const std::string& name, const RequestContext& context);

/// What is known of an imported scene without reading it, beside it in its folder: {"title",
/// "notes"}.
inline constexpr const char* about_scene_file = "scene.about";

/// The title and notes that its upload left; the id and no notes for a scene that was put there by
/// hand.
nlohmann::json about_imported_scene(const std::filesystem::path& data, const std::string& id);

/// Ids of the imported scenes in a data folder, sorted.
std::vector<std::string> imported_scenes(const std::filesystem::path& data);

}  // namespace penumbra::server
