#pragma once

#include <fcntl.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace penumbra::faults {

/// Drives broken_system.c from outside the server it is loaded into. `place` is a folder for its
/// files, outside the data.
class BrokenSystem {
 public:
  BrokenSystem(std::filesystem::path place_, std::filesystem::path data_)
      : place(std::move(place_)), data(std::move(data_)) {
    std::filesystem::create_directories(place / "shadow");
  }

  /// Disk below data/`part` that can be full, and the clock.
  std::map<std::string, std::string> environment(const std::string& part = "") const {
    return {{"LD_PRELOAD", PENUMBRA_BROKEN_SYSTEM},
            {"FAULT_FULL", (place / "full").string()},
            {"FAULT_FULL_UNDER", (part.empty() ? data : data / part).string()},
            {"FAULT_CLOCK", (place / "clock").string()}};
  }
  /// The same, and what is synced is kept for `cut_power`.
  std::map<std::string, std::string> with_shadow() const {
    auto all = environment();
    all["FAULT_ROOT"] = data.string();
    all["FAULT_SHADOW"] = (place / "shadow").string();
    return all;
  }

  void fill_disk() const { std::ofstream(place / "full") << "full"; }
  void free_disk() const { std::filesystem::remove(place / "full"); }
  void move_clock(long seconds) const {
    std::ofstream(place / "fresh") << seconds;
    std::filesystem::rename(place / "fresh", place / "clock");
  }

  /// Takes everything that is there now for synced.
  void take_as_synced() const {
    keep_folder(data);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data))
      if (entry.is_directory())
        keep_folder(entry.path());
      else
        std::filesystem::copy_file(entry.path(), place / "shadow" / identity(entry.path()));
  }

  /// Replaces the data by what was synced. The server must be dead.
  void cut_power() const {
    const auto left = place / "left";
    std::filesystem::create_directory(left);
    restore(id_of_root(), left);
    std::filesystem::permissions(left, std::filesystem::perms::owner_all);
    std::filesystem::remove_all(data);
    std::filesystem::rename(left, data);
    std::filesystem::remove_all(place / "shadow");
    std::filesystem::create_directory(place / "shadow");
    take_as_synced();
  }

 private:
  /// As broken_system.c names what was synced.
  static std::string identity(const std::filesystem::path& path) {
    struct statx state {};
    ::statx(AT_FDCWD, path.c_str(), AT_SYMLINK_NOFOLLOW, STATX_INO | STATX_BTIME | STATX_MODE,
            &state);
    return std::string(S_ISDIR(state.stx_mode) ? "d" : "f") + "-" + std::to_string(state.stx_ino) +
           "-" + std::to_string(state.stx_btime.tv_sec) + "-" +
           std::to_string(state.stx_btime.tv_nsec);
  }
  void keep_folder(const std::filesystem::path& path) const {
    std::ofstream list(place / "shadow" / identity(path));
    for (const auto& entry : std::filesystem::directory_iterator(path))
      list << identity(entry.path()) << '\t' << entry.path().filename().string() << '\n';
  }

  /// The synced folder that lists the database.
  std::string id_of_root() const {
    for (const auto& entry : std::filesystem::directory_iterator(place / "shadow")) {
      const auto name = entry.path().filename().string();
      if (name.front() != 'd') continue;
      std::ifstream lines(entry.path());
      for (std::string line; std::getline(lines, line);)
        if (line.ends_with("\tpenumbra.sqlite")) return name;
    }
    return {};
  }

  void restore(const std::string& id, const std::filesystem::path& target) const {
    std::ifstream lines(place / "shadow" / id);
    for (std::string line; std::getline(lines, line);) {
      const auto tab = line.find('\t');
      const auto inner = line.substr(0, tab);
      const auto path = target / line.substr(tab + 1);
      if (inner.front() == 'd') {
        std::filesystem::create_directory(path);
        restore(inner, path);
      } else if (std::filesystem::exists(place / "shadow" / inner)) {
        std::filesystem::copy_file(place / "shadow" / inner, path);
      } else {
        std::ofstream empty(path);
      }
    }
  }

  std::filesystem::path place;
  std::filesystem::path data;
};

}  // namespace penumbra::faults
