#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace penumbra::experiments {

/// Results of one experiment: a file with a line of JSON each, appended as they come. What is in it
/// is never measured again: a key holds everything that a result depends on.
class Results {
 public:
  /// Reads what is there; a last line that was cut off is dropped. The file is this process's until
  /// the object or the process ends, whatever becomes of its children. Throws Error `busy` where
  /// another process writes it, `unwritable`.
  explicit Results(const std::filesystem::path& file);
  ~Results();
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;

  /// Null where nothing is known.
  const nlohmann::json* find(const std::string& key) const;
  /// On disk when this returns, so far as the operating system keeps its word. The first result of
  /// a key stays: two processes may have drawn one picture at once.
  void add(const std::string& key, const nlohmann::json& result);
  std::size_t size() const { return rows_.size(); }

 private:
  void read();

  std::filesystem::path path_;
  int file_ = -1;
  std::map<std::string, nlohmann::json> rows_;
};

}  // namespace penumbra::experiments
