#include "server/http/scene_upload.h"

#include <fcntl.h>
#include <stdio.h>
#include <zip.h>

#include <algorithm>
#include <cctype>
#include <mutex>
#include <set>
#include <vector>

#include "renderer/error.h"
#include "scenes/json_text.h"
#include "scenes/library.h"
#include "server/http/secrets.h"
#include "server/jobs/request_scene.h"
#include "server/storage/data_folder.h"
#include "server/storage/folder_files.h"

namespace penumbra::server::http {
namespace {

namespace fs = std::filesystem;

constexpr zip_int64_t most_files = 1000;
constexpr zip_uint64_t most_bytes = 512u << 20;
constexpr zip_uint64_t largest_ratio = 200;   // of bytes unpacked to packed; deflate ends near 1000
constexpr zip_uint64_t small_file = 1 << 20;  // below this the ratio does no harm

struct Archive {
  zip_t* handle;
  ~Archive() {
    if (handle != nullptr) zip_discard(handle);
  }
};

struct Entry {
  zip_file_t* handle;
  ~Entry() {
    if (handle != nullptr) zip_fclose(handle);
  }
};

void check_name(const std::string& name) {
  const auto refuse = [&] {
    throw unreadable("the archive names the file '" + name + "'", "body");
  };
  if (name.empty() || name.front() == '/' || name.size() > 255) refuse();
  if (name.find_first_of("\\:") != std::string::npos) refuse();
  for (const unsigned char c : name)
    if (c < 0x20) refuse();
  for (const auto& part : fs::path(name))
    if (part == ".." || part == ".") refuse();
}

/// Refuses two entries of one name, and one that is a file here and a folder there.
void note_name(const std::string& name, std::set<fs::path>& files, std::set<fs::path>& folders) {
  const bool is_folder = name.ends_with('/');
  const fs::path path =
      fs::path(is_folder ? name.substr(0, name.size() - 1) : name).lexically_normal();
  bool fits = is_folder || files.insert(path).second;
  if (is_folder) folders.insert(path);
  for (fs::path above = path.parent_path(); !above.empty(); above = above.parent_path())
    folders.insert(above);
  for (fs::path above = path; fits && !above.empty(); above = above.parent_path())
    fits = !(files.contains(above) && folders.contains(above));
  if (!fits) throw unreadable("the archive names '" + name + "' twice", "body");
}

bool is_link(zip_t* archive, zip_uint64_t index) {
  zip_uint8_t system = 0;
  zip_uint32_t attributes = 0;
  if (zip_file_get_external_attributes(archive, index, 0, &system, &attributes) != 0) return true;
  constexpr zip_uint32_t kind = 0170000;
  constexpr zip_uint32_t regular = 0100000;
  constexpr zip_uint32_t folder = 0040000;
  const zip_uint32_t mode = attributes >> 16 & kind;
  return system == ZIP_OPSYS_UNIX && mode != 0 && mode != regular && mode != folder;
}

std::string bytes_of(zip_t* archive, zip_uint64_t index, zip_uint64_t size) {
  Entry entry{zip_fopen_index(archive, index, 0)};
  if (entry.handle == nullptr) throw unreadable("a file of the archive cannot be opened", "body");
  std::string bytes(size, '\0');
  zip_uint64_t done = 0;
  while (done < size) {
    const auto count = zip_fread(entry.handle, bytes.data() + done, size - done);
    if (count <= 0) throw unreadable("a file of the archive cannot be unpacked", "body");
    done += static_cast<zip_uint64_t>(count);
  }
  char more = 0;
  if (zip_fread(entry.handle, &more, 1) != 0)
    throw unreadable("a file of the archive is longer than it says", "body");
  return bytes;
}

/// The one file in a folder that a scene is read from.
fs::path main_file(const fs::path& folder) {
  const std::vector<fs::path> found = scenes::scene_files(folder);
  if (found.size() != 1)
    throw unreadable(
        "the archive must hold one .gltf, .glb or .obj file, or one scene document, "
        "not " +
            std::to_string(found.size()),
        "body");
  return found.front();
}

/// Text with vertices in it.
bool looks_like_obj(const std::string& bytes) {
  return bytes.find('\0') == std::string::npos &&
         (bytes.starts_with("v ") || bytes.find("\nv ") != std::string::npos ||
          bytes.find("\rv ") != std::string::npos);
}

/// Name of the file that a body goes into, told by its bytes.
const char* file_name_of(const std::string& bytes) {
  if (bytes.starts_with("glTF")) return "scene.glb";
  const auto first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first != std::string::npos && bytes[first] == '{') {
    const bool gltf = bytes.find("\"penumbra_scene\"") == std::string::npos &&
                      bytes.find("\"asset\"") != std::string::npos;
    return gltf ? "scene.gltf" : "scene.json";
  }
  if (looks_like_obj(bytes)) return "scene.obj";
  throw unreadable("neither glTF, nor OBJ, nor a zip, nor a scene document", "body");
}

fs::path write_upload(const fs::path& folder, const std::string& bytes) {
  if (is_zip(bytes)) {
    unpack(bytes, folder);
    return main_file(folder);
  }
  const fs::path file = folder / file_name_of(bytes);
  storage::write_file_durably(file, bytes);
  return file;
}

/// Reads it for good; messages name the file as the sender knows it.
nlohmann::json read_upload(const ReadScene& read, const fs::path& file, const fs::path& folder) {
  try {
    return read(file);
  } catch (const Error& error) {
    std::string message = error.what();
    const auto prefix = folder.string() + "/";
    for (auto at = message.find(prefix); at != std::string::npos; at = message.find(prefix))
      message.erase(at, prefix.size());
    throw Error(error.code == "not_found" ? "unreadable" : error.code, message, error.field);
  }
}

/// Uploads of one id may come at the same time; one process owns the folder.
std::mutex& replacing() {
  static std::mutex mutex;
  return mutex;
}

/// Puts a folder in the place of another, or of none, at once: there is no time without a scene.
void exchange(const fs::path& fresh, const fs::path& place) {
  if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, place.c_str(), RENAME_EXCHANGE) == 0) return;
  // Not every file system exchanges; then there is a moment without one.
  if (fs::is_directory(place)) fs::rename(place, fresh.parent_path() / "old");
  fs::rename(fresh, place);
}

/// Where a scene of that id lies: an uploaded one is a folder, one of the command line a file.
std::vector<fs::path> places_of(const fs::path& data, const std::string& id) {
  std::vector<fs::path> places;
  if (!fs::is_directory(data / "scenes")) return places;
  for (const auto& entry : fs::directory_iterator(data / "scenes"))
    if ((entry.is_directory() ? entry.path().filename() : entry.path().stem()) == id)
      places.push_back(entry.path());
  return places;
}

}  // namespace

void check_scene_id(const std::string& id) {
  const bool letters = std::all_of(id.begin(), id.end(), [](unsigned char c) {
    return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '-' || c == '_';
  });
  if (id.empty() || id.size() > 64 || !letters || id.front() == '-' || id.front() == '_')
    throw bad_value("id", "must be 1 to 64 of a-z, 0-9, - and _, beginning with a letter or digit");
}

Staging::Staging(const fs::path& data) : path(data / storage::incoming_name / random_uuid()) {
  fs::create_directories(path);
}

Staging::~Staging() {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

bool is_zip(const std::string& bytes) {
  return bytes.starts_with("PK\x03\x04");
}

void unpack(const std::string& bytes, const fs::path& folder) {
  zip_error_t failure;
  zip_error_init(&failure);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &failure);
  Archive archive{source != nullptr
                      ? zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &failure)
                      : nullptr};
  if (archive.handle == nullptr) {
    if (source != nullptr) zip_source_free(source);
    throw unreadable("the zip archive is damaged", "body");
  }
  const auto count = zip_get_num_entries(archive.handle, 0);
  if (count > most_files)
    throw unreadable("the archive holds more than " + std::to_string(most_files) + " files",
                     "body");
  zip_uint64_t total = 0;
  std::set<fs::path> files;
  std::set<fs::path> folders;
  for (zip_uint64_t i = 0; i < static_cast<zip_uint64_t>(count); ++i) {
    zip_stat_t stat;
    if (zip_stat_index(archive.handle, i, 0, &stat) != 0)
      throw unreadable("the zip archive is damaged", "body");
    const std::string name = stat.name;
    check_name(name);
    if (is_link(archive.handle, i)) throw unreadable("the archive holds a link: " + name, "body");
    note_name(name, files, folders);
    if (name.ends_with('/')) continue;
    if (name.ends_with(".zip")) throw unreadable("the archive holds an archive", "body");
    if (stat.size > small_file &&
        stat.size / std::max<zip_uint64_t>(stat.comp_size, 1) > largest_ratio)
      throw unreadable("the archive is packed too tightly: " + name, "body");
    if (stat.size > most_bytes - total)
      throw unreadable("the archive holds more than " + std::to_string(most_bytes) + " bytes",
                       "body");
    total += stat.size;
    const auto file = folder / name;
    fs::create_directories(file.parent_path());
    storage::write_file_durably(file, bytes_of(archive.handle, i, stat.size));
  }
}

nlohmann::json store_scene(const fs::path& data, const std::string& id, const std::string& bytes,
                           const ReadScene& read) {
  const Staging staging(data);
  const auto fresh = staging.path / "scene";
  fs::create_directories(fresh);
  nlohmann::json about = read_upload(read, write_upload(fresh, bytes), fresh);
  storage::write_file_durably(fresh / about_scene_file, scenes::json_text(about));
  fs::create_directories(data / "scenes");
  const std::lock_guard lock(replacing());
  const auto old = places_of(data, id);
  exchange(fresh, data / "scenes" / id);
  // A file of the command line goes last: while both are there, it is the scene.
  for (const auto& place : old)
    if (place != data / "scenes" / id) fs::remove_all(place);
  about["replaced"] = !old.empty();
  return about;
}

bool remove_scene(const fs::path& data, const std::string& id) {
  const std::lock_guard lock(replacing());
  const auto places = places_of(data, id);
  for (const auto& place : places) fs::remove_all(place);
  return !places.empty();
}

}  // namespace penumbra::server::http
