#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "renderer/scene/scene.h"
#include "scenes/import/notes.h"

namespace penumbra::scenes {

/// Decoded bytes of all textures of a scene together, four a texel.
constexpr std::uint64_t max_texture_bytes = std::uint64_t{1} << 30;

std::uint64_t texture_bytes(const Scene& scene);

/// Files that a scene's file names: opened in its folder and below, nowhere else.
class SideFiles {
 public:
  SideFiles(std::filesystem::path folder_, Notes& notes_);

  /// Bytes of the file; where it is missing or may not be opened nothing, and a note that begins
  /// with `where`. Names with backslashes are those of another system, and mean the same.
  std::optional<std::string> read(const std::string& name, const std::string& where);
  /// Whether `read` would find it.
  bool has(const std::string& name) const;

 private:
  std::filesystem::path folder;
  Notes& notes;
};

/// Decodes pictures into textures of a scene: equal bytes once, all together within a bound.
class TextureStore {
 public:
  /// `most_bytes` is what the textures may take, those included that the scene has already.
  TextureStore(Scene& scene_, Notes& notes_, std::uint64_t most_bytes_);

  /// Index of the texture; -1 and a note that begins with `where` for bytes that are no picture or
  /// more than may be.
  int add(const std::string& name, std::string_view bytes, const std::string& where);

  /// As add, but always with an index of its own; what cannot be read is one white texel.
  int add_in_order(const std::string& name, std::string_view bytes, const std::string& where);

 private:
  bool decode(const std::string& name, std::string_view bytes, const std::string& where);

  Scene& scene;
  Notes& notes;
  std::uint64_t most_bytes;
  std::map<std::string, int> known;  ///< by digest of the encoded bytes
};

}  // namespace penumbra::scenes
