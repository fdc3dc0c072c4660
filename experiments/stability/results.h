#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace penumbra::experiments::stability {

/// Results of one folder, a line of JSON each, appended as they come. What is in it is never drawn
/// again: a key holds everything that a result depends on.
class Results {
 public:
  /// Reads what is there; a last line that was cut off is dropped. Throws Error `unwritable`.
  explicit Results(const std::filesystem::path& file);

  const nlohmann::json* find(const std::string& key) const;
  void add(const std::string& key, const nlohmann::json& result);
  std::size_t size() const { return rows_.size(); }

 private:
  std::filesystem::path file_;
  std::map<std::string, nlohmann::json> rows_;
};

}  // namespace penumbra::experiments::stability
