#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace penumbra::server::http {

/// Throws bad_value for anything but 1 to 64 of a-z 0-9 - _, beginning with a letter or digit.
void check_scene_id(const std::string& id);

/// Reads a scene's file and says what it is: {"title","notes"}. Throws what is wrong with it.
using ReadScene = std::function<nlohmann::json(const std::filesystem::path&)>;

/// Checks and stores an uploaded scene as data/scenes/ID/: glTF, OBJ, a scene document, or a zip
/// with one of them and what it names; which one is told by its first bytes. The old scene of that
/// id stays where the new one cannot be read. Returns what `read` said and whether there was an old
/// one, `replaced`. Throws unreadable, bad_value.
nlohmann::json store_scene(const std::filesystem::path& data, const std::string& id,
                           const std::string& bytes, const ReadScene& read);

/// False where there is no such scene.
bool remove_scene(const std::filesystem::path& data, const std::string& id);

/// A folder for what is uploaded, gone at the end of its block.
struct Staging {
  explicit Staging(const std::filesystem::path& data);
  ~Staging();
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  std::filesystem::path path;
};

/// Largest upload of a scene, a picture or a study with pictures, bytes; nginx's limit in deploy/
/// is the same.
inline constexpr std::size_t largest_upload = 256u << 20;

/// Told by the first bytes.
bool is_zip(const std::string& bytes);

/// Unpacks a zip of regular files into a folder. Throws unreadable for names that lead outside, for
/// links, names that come twice, archives inside, more than 1000 files, over 512 MiB, or over 200
/// bytes from one.
void unpack(const std::string& zip, const std::filesystem::path& folder);

}  // namespace penumbra::server::http
