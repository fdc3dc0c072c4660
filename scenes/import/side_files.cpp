#include "scenes/import/side_files.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "renderer/error.h"
#include "scenes/import/import.h"
#include "scenes/picture_io.h"
#include "scenes/text.h"

namespace penumbra::scenes {
namespace fs = std::filesystem;
namespace {

/// Changes whenever the bytes do.
std::string digest_of(std::string_view bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return std::to_string(hash.high64) + "-" + std::to_string(hash.low64) + "-" +
         std::to_string(bytes.size());
}

std::string portable(std::string name) {
  for (char& c : name)
    if (c == '\\') c = '/';
  return name;
}

}  // namespace

std::uint64_t texture_bytes(const Scene& scene) {
  std::uint64_t sum = 0;
  for (const Texture& texture : scene.textures) sum += texture.rgba.size();
  return sum;
}

SideFiles::SideFiles(fs::path folder_, Notes& notes_) : folder(std::move(folder_)), notes(notes_) {}

std::optional<std::string> SideFiles::read(const std::string& name, const std::string& where) {
  try {
    const fs::path file = resolve_inside(folder, portable(name), where);
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored)) return read_bytes(file);
    notes.add(where, " " + in_quotes(name) + " is missing: it is left out");
  } catch (const Error& error) {
    notes.add("", std::string(error.what()) + ": it is left out");
  }
  return {};
}

bool SideFiles::has(const std::string& name) const {
  try {
    std::error_code ignored;
    return fs::is_regular_file(resolve_inside(folder, portable(name), ""), ignored);
  } catch (const Error&) {
    return false;
  }
}

TextureStore::TextureStore(Scene& scene_, Notes& notes_, std::uint64_t most_bytes_)
    : scene(scene_), notes(notes_), most_bytes(most_bytes_) {}

bool TextureStore::decode(const std::string& name, std::string_view bytes,
                          const std::string& where) {
  try {
    const std::uint64_t used = texture_bytes(scene);
    Image8 picture = decode_picture(bytes, most_bytes - std::min(used, most_bytes));
    scene.textures.push_back({name, picture.width, picture.height, std::move(picture.pixels)});
    return true;
  } catch (const Error& error) {
    notes.add(where, std::string(": ") + error.what() + ": it is left out");
    return false;
  }
}

int TextureStore::add(const std::string& name, std::string_view bytes, const std::string& where) {
  const auto [entry, added] = known.try_emplace(digest_of(bytes), -1);
  if (added && decode(name, bytes, where))
    entry->second = static_cast<int>(scene.textures.size()) - 1;
  return entry->second;
}

int TextureStore::add_in_order(const std::string& name, std::string_view bytes,
                               const std::string& where) {
  if (!decode(name, bytes, where)) scene.textures.push_back({name, 1, 1, {255, 255, 255, 255}});
  return static_cast<int>(scene.textures.size()) - 1;
}

}  // namespace penumbra::scenes
