// Requests written as text: URL queries, --set and --light.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>

#include "renderer/error.h"
#include "server/jobs/canonical_request.h"

namespace penumbra::server {
namespace {

using nlohmann::json;

enum class Kind { text, integer, number, boolean, list };

/// The field of a request that holds them, and their name in an example.
struct Changes {
  Changed what;
  std::string one;
  std::string list;
  std::string example;
};

const std::vector<Changes>& all_changes() {
  static const std::vector<Changes> changes{
      {Changed::light, "light", "lights", "key.intensity=2"},
      {Changed::camera, "camera", "cameras", "main.position=1,2,3"}};
  return changes;
}

/// Keys of a request that text can set; every other name is a parameter of the technique.
const std::map<std::string, Kind>& request_keys() {
  static const std::map<std::string, Kind> keys{{"scene", Kind::text},
                                                {"technique", Kind::text},
                                                {"camera", Kind::text},
                                                {"camera_path", Kind::list},
                                                {"diagnostic", Kind::text},
                                                {"width", Kind::integer},
                                                {"height", Kind::integer},
                                                {"supersampling", Kind::integer},
                                                {"light_samples", Kind::integer},
                                                {"error_bound", Kind::number},
                                                {"exposure", Kind::number},
                                                {"seed", Kind::integer},
                                                {"frames", Kind::integer},
                                                {"measure", Kind::boolean}};
  return keys;
}

std::uint64_t integer_from(const std::string& name, const std::string& text) {
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  errno = 0;
  const std::uint64_t value = digits ? std::strtoull(text.c_str(), nullptr, 10) : 0;
  if (!digits || errno == ERANGE)
    throw bad_value(name, name + " must be a whole number, not \"" + text + "\"");
  return value;
}

bool boolean_from(const std::string& name, const std::string& text) {
  if (text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  throw bad_value(name, name + " must be true or false, not \"" + text + "\"");
}

/// A finite number, or nothing.
std::optional<double> number_from(const std::string& text) {
  if (text.empty() || std::isspace(static_cast<unsigned char>(text.front()))) return {};
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (*end != '\0' || !std::isfinite(value)) return {};
  return value;
}

/// "1,2,3" as numbers; empty where a part is none.
json list_from(const std::string& text) {
  json list = json::array();
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto number = number_from(text.substr(begin, end - begin));
    if (!number) return {};
    list.push_back(*number);
    begin = end + 1;
  }
  return list;
}

json override_value(const std::string& text) {
  if (const auto number = number_from(text)) return *number;
  if (text.find(',') != std::string::npos)
    if (json list = list_from(text); !list.is_null()) return list;
  json value = json::parse(text, nullptr, false);
  return value.is_discarded() ? json(text) : value;
}

/// Entry of an object, made where it is not there yet. Where a value stands instead of the object,
/// the entry was given as a whole and in part.
json& entry_of(json& place, const std::string& key, const std::string& field) {
  if (!place.is_null() && !place.is_object())
    throw bad_value(field, field + " is given twice: as a whole and in part");
  return place[key];
}

}  // namespace

void add_override(json& request, Changed what, const std::string& path, const std::string& value) {
  const Changes& changes = all_changes().at(static_cast<std::size_t>(what));
  const std::string field = changes.list + "." + path;
  const std::size_t dot = path.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == path.size())
    throw bad_value(field, "a " + changes.one + " is changed by NAME.key=value, as in " +
                               changes.example + ", not \"" + path + "\"");
  // A key may lie deeper: NAME.extent.radius.
  json* place = &request[changes.list][path.substr(0, dot)];
  std::size_t begin = dot + 1;
  for (std::size_t end = path.find('.', begin); end != std::string::npos;
       begin = end + 1, end = path.find('.', begin))
    place = &entry_of(*place, path.substr(begin, end - begin), field);
  json& entry = entry_of(*place, path.substr(begin), field);
  if (!entry.is_null()) throw bad_value(field, field + " is given twice");
  entry = override_value(value);
}

json request_from_text(const std::vector<std::pair<std::string, std::string>>& entries) {
  json request = json::object();
  std::set<std::string> seen;
  for (const auto& [name, value] : entries) {
    if (!seen.insert(name).second) throw bad_value(name, name + " is given twice");
    // clang lets no lambda capture a structured binding.
    const auto names_it = [&text = name](const Changes& entry) {
      return text.starts_with(entry.one + ".");
    };
    const auto changes = std::find_if(all_changes().begin(), all_changes().end(), names_it);
    if (changes != all_changes().end()) {
      add_override(request, changes->what, name.substr(changes->one.size() + 1), value);
      continue;
    }
    const auto key = request_keys().find(name);
    if (key == request_keys().end()) {
      request["parameters"][name] = value;
    } else if (key->second == Kind::integer) {
      request[name] = integer_from(name, value);
    } else if (key->second == Kind::number) {
      const auto number = number_from(value);
      if (!number) throw bad_value(name, name + " must be a number, not \"" + value + "\"");
      request[name] = *number;
    } else if (key->second == Kind::boolean) {
      request[name] = boolean_from(name, value);
    } else if (key->second == Kind::list) {
      json list = json::parse(value, nullptr, false);
      if (!list.is_array()) throw bad_value(name, name + " must be a list in JSON");
      request[name] = std::move(list);
    } else {
      request[name] = value;
    }
  }
  return request;
}

}  // namespace penumbra::server
