#include "server/storage/backup.h"

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zip.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "renderer/error.h"
#include "server/files/digest.h"
#include "server/files/durable_file.h"
#include "server/storage/data_folder.h"
#include "server/storage/examination.h"
#include "server/storage/folder_files.h"
#include "server/storage/seals.h"

namespace penumbra::server::storage {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* manifest_name = "manifest.json";
constexpr int copy_busy_ms = 10000;

using Archive = std::unique_ptr<zip_t, decltype(&zip_discard)>;

/// Whether the folder is in use; the lock is held until the end of the block where it is not.
struct Ownership {
  explicit Ownership(const fs::path& data) {
    try {
      folder.emplace(data);
    } catch (const Error& error) {
      if (error.code != "conflict") throw;
    }
  }
  Owner owner() const { return folder ? Owner::this_process : Owner::another; }
  std::optional<DataFolder> folder;
};

void require_folder(const fs::path& data) {
  if (!fs::is_regular_file(data / database_name))
    throw not_found("data", data.string() + " holds no database");
}

/// Rows and journal of an open copy or original.
std::vector<std::string> check_rows(SQLite::Database& connection, const Journal& journal,
                                    Owner owner) {
  std::vector<std::string> wrong;
  SQLite::Transaction snapshot(connection);
  for (const auto& damage : examine(connection, journal, owner).damage)
    wrong.push_back(text_of(damage));
  return wrong;
}

std::vector<std::string> check_pictures(SQLite::Database& connection, const fs::path& folder) {
  std::vector<std::string> wrong;
  SQLite::Statement query(connection, "SELECT DISTINCT digest FROM main.pictures ORDER BY 1");
  while (query.executeStep()) {
    const auto digest = query.getColumn(0).getString();
    const auto bytes = read_whole(folder / (digest + ".png"));
    if (!bytes)
      wrong.push_back("pictures/" + digest + ".png is missing");
    else if (sha256(*bytes) != digest)
      wrong.push_back("pictures/" + digest + ".png is altered");
  }
  return wrong;
}

void check_permissions(const fs::path& path, std::vector<std::string>& wrong) {
  using fs::perms;
  std::error_code failure;
  const auto state = fs::status(path, failure).permissions();
  if (!failure && (state & (perms::group_all | perms::others_all)) != perms::none)
    wrong.push_back(path.filename().string() + " is open to other users");
}

/// Adds what the folder's database says to `wrong`. Tried again while another process compacts the
/// journal between two looks.
void check_database(const fs::path& data, Owner owner, std::vector<std::string>& wrong) {
  const auto key = read_whole(data / key_name);
  if (!key) return wrong.push_back("integrity.key is missing");
  if (fs::file_size(data / database_name) == 0) return wrong.push_back("the database is empty");
  SQLite::Database connection((data / database_name).string(), SQLite::OPEN_READONLY, copy_busy_ms);
  if (const auto state = connection.execAndGet("PRAGMA integrity_check").getString(); state != "ok")
    return wrong.push_back("the database's structure is damaged: " + state);
  Seals(*key).add_function(connection);
  Seals::add_views(connection);
  const Journal journal(data / journal_name, *key);
  auto rows = check_rows(connection, journal, owner);
  for (int again = 0; again < 3 && !rows.empty() && owner == Owner::another; ++again)
    rows = check_rows(connection, journal, owner);
  wrong.insert(wrong.end(), rows.begin(), rows.end());
  const auto pictures = check_pictures(connection, data / pictures_name);
  wrong.insert(wrong.end(), pictures.begin(), pictures.end());
}

void copy_files(const fs::path& from, const fs::path& to) {
  if (!fs::is_directory(from)) return;
  make_private_folder(to);
  for (const auto& entry : fs::directory_iterator(from)) {
    const auto name = entry.path().filename();
    if (entry.is_directory())
      copy_files(entry.path(), to / name);
    else if (entry.is_regular_file())
      write_file_durably(to / name, read_file(entry.path()));
  }
}

[[noreturn]] void fail(const std::string& what) {
  throw Error("storage", "the backup cannot be written: " + what);
}

void add_file(zip_t* archive, const fs::path& file, const std::string& name) {
  zip_source_t* source = zip_source_file(archive, file.c_str(), 0, -1);
  const auto index = zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) fail(zip_strerror(archive));
  const auto at = static_cast<zip_uint64_t>(index);
  if (file.extension() == ".png") zip_set_file_compression(archive, at, ZIP_CM_STORE, 0);
  constexpr zip_uint32_t owner_only = 0100600;  // of a UNIX file, in the upper half
  zip_file_set_external_attributes(archive, at, 0, ZIP_OPSYS_UNIX, owner_only << 16);
}

void zip_folder(const fs::path& folder, const fs::path& out) {
  int failure = 0;
  Archive archive(zip_open(out.c_str(), ZIP_CREATE | ZIP_EXCL, &failure), &zip_discard);
  if (!archive) fail(out.string());
  json files = json::array();
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const auto bytes = read_file(entry.path());
    const auto name = fs::relative(entry.path(), folder).generic_string();
    files.push_back({{"path", name}, {"bytes", bytes.size()}, {"sha256", sha256(bytes)}});
    add_file(archive.get(), entry.path(), name);
  }
  const auto manifest = folder / manifest_name;
  write_file_durably(manifest, json{{"format", 1}, {"files", files}}.dump(2) + "\n");
  add_file(archive.get(), manifest, manifest_name);
  if (zip_close(archive.get()) != 0) fail(zip_strerror(archive.get()));
  archive.release();
  const int file = ::open(out.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = file >= 0 && ::fchmod(file, 0600) == 0 && ::fsync(file) == 0;
  if (file >= 0) ::close(file);
  if (!synced) fail(out.string());
}

std::string entry_of(zip_t* archive, const std::string& name) {
  zip_stat_t about;
  if (zip_stat(archive, name.c_str(), 0, &about) != 0) throw unreadable(name + " is missing in it");
  std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file(zip_fopen(archive, name.c_str(), 0),
                                                          &zip_fclose);
  std::string bytes(about.size, '\0');
  const auto count = file ? zip_fread(file.get(), bytes.data(), bytes.size()) : -1;
  if (count != static_cast<zip_int64_t>(bytes.size())) throw unreadable(name + " cannot be read");
  return bytes;
}

void make_folders(const fs::path& root, const fs::path& inner) {
  fs::path at = root;
  for (const auto& part : inner) make_private_folder(at /= part);
}

}  // namespace

std::vector<std::string> copy_folder(const fs::path& data, const fs::path& copy) {
  require_folder(data);
  const Ownership ownership(data);
  make_private_folder(copy);
  write_file_durably(copy / database_name, "");  // SQLite would make it as the umask allows
  {
    SQLite::Database source((data / database_name).string(), SQLite::OPEN_READONLY, copy_busy_ms);
    SQLite::Database target((copy / database_name).string(), SQLite::OPEN_READWRITE, copy_busy_ms);
    SQLite::Backup(target, source).executeStep(-1);
  }
  for (const char* name : {key_name, token_name})
    if (const auto bytes = read_whole(data / name)) write_file_durably(copy / name, *bytes);
  copy_files(data / pictures_name, copy / pictures_name);
  copy_files(data / "scenes", copy / "scenes");
  if (const auto key = read_whole(data / key_name)) {
    // The journal up to the copy's last commit: the original may have gone on since.
    SQLite::Database target((copy / database_name).string(), SQLite::OPEN_READONLY, copy_busy_ms);
    Seals(*key).add_function(target);
    Seals::add_views(target);
    const Journal original(data / journal_name, *key);
    const auto found = examine(target, original, ownership.owner());
    if (found.damage.empty())
      Journal(copy / journal_name, *key).compact(found.journal);
    else if (const auto bytes = read_whole(data / journal_name))
      write_file_durably(copy / journal_name, *bytes);
  }
  return verify_folder(copy);
}

void back_up(const fs::path& data, const fs::path& out) {
  if (fs::exists(out)) throw Error("conflict", out.string() + " is there already", "out");
  const auto part = out.string() + ".part" + std::to_string(::getpid());
  const PassingFolder passing(part);
  const auto copy = passing.path / "data";
  std::vector<std::string> wrong;
  for (int attempt = 0; attempt < 3; ++attempt) {
    fs::remove_all(copy);
    wrong = copy_folder(data, copy);
    if (wrong.empty()) break;
  }
  if (!wrong.empty())
    throw Error("storage", "the data folder is damaged and is not backed up: " + wrong.front(),
                "data");
  const auto archive = passing.path / "backup.zip";
  zip_folder(copy, archive);
  fs::rename(archive, out);
}

void restore(const fs::path& backup, const fs::path& data) {
  int failure = 0;
  const Archive archive(zip_open(backup.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &failure),
                        &zip_discard);
  if (!archive) throw unreadable(backup.string() + " is no backup, or is damaged");
  if (fs::exists(data) && (!fs::is_directory(data) || !fs::is_empty(data)))
    throw Error("conflict", data.string() + " is not empty", "data");
  const auto manifest = json::parse(entry_of(archive.get(), manifest_name), nullptr, false);
  if (!manifest.is_object() || !manifest.contains("files"))
    throw unreadable(backup.string() + " has no manifest");
  make_private_folder(data);
  for (const auto& entry : manifest.at("files")) {
    const auto name = entry.at("path").get<std::string>();
    const fs::path inner(name);
    if (inner.is_absolute() || inner.lexically_normal() != inner || name.starts_with(".."))
      throw unreadable("the backup names a path outside of itself");
    const auto bytes = entry_of(archive.get(), name);
    if (sha256(bytes) != entry.at("sha256")) throw unreadable(name + " is altered in the backup");
    make_folders(data, inner.parent_path());
    write_file_durably(data / inner, bytes);
  }
}

std::vector<std::string> verify_folder(const fs::path& data) {
  require_folder(data);
  const Ownership ownership(data);
  std::vector<std::string> wrong;
  check_permissions(data, wrong);
  for (const char* name : secret_names) check_permissions(data / name, wrong);
  try {
    check_database(data, ownership.owner(), wrong);
  } catch (const std::exception& error) {
    wrong.push_back(std::string("the database cannot be read: ") + error.what());
  }
  return wrong;
}

}  // namespace penumbra::server::storage
