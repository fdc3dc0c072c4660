#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "renderer/error.h"

namespace penumbra::scenes {

/// Reads one JSON object key by key. Errors are `unreadable` with the path of the value as field;
/// `finish` refuses keys that were not asked for and names those that there are.
class JsonReader {
 public:
  JsonReader(const nlohmann::json& value_, std::string path_);

  bool has(const std::string& key);
  const nlohmann::json& at(const std::string& key);  ///< throws where it is missing
  std::string path_of(const std::string& key) const;

  /// Each leaves `out` as it is where the key is missing. Ranges include both ends.
  void number(const std::string& key, double& out, double low, double high);
  void number(const std::string& key, float& out, double low, double high);
  void integer(const std::string& key, std::int64_t& out, std::int64_t low, std::int64_t high);
  void boolean(const std::string& key, bool& out);
  void text(const std::string& key, std::string& out);
  void vector(const std::string& key, glm::dvec2& out, double low, double high);
  void vector(const std::string& key, glm::dvec3& out, double low, double high);
  void color(const std::string& key, glm::vec3& out);  ///< linear, components 0..1e30

  /// One of the names; `out` becomes its enumerator.
  template <class T>
  void choice(const std::string& key, T& out,
              const std::vector<std::pair<const char*, T>>& choices) {
    if (!has(key)) return;
    std::string given, names;
    text(key, given);
    for (const auto& [name, value_of] : choices) {
      if (given == name) {
        out = value_of;
        return;
      }
      names += (names.empty() ? "" : ", ") + std::string(name);
    }
    fail(key, "is '" + given + "', must be one of " + names);
  }

  void finish() const;
  [[noreturn]] void fail(const std::string& key, const std::string& what) const;

 private:
  const nlohmann::json* value;
  std::string path;
  std::set<std::string> asked;
};

/// Finite numbers of a flat array, each in the range; throws naming the element.
std::vector<double> read_numbers(const nlohmann::json& value, const std::string& path, double low,
                                 double high);

/// Largest coordinate that a scene may have, metres: beyond it squares overflow a float.
constexpr double max_coordinate = 1e15;

/// Brightest a light may be: with it a lamp at any allowed distance lights what it may.
constexpr double max_intensity = 1e30;

}  // namespace penumbra::scenes
