#include "server/http/body.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace penumbra::server::http {
namespace {

constexpr std::size_t deepest = 64;

bool valid_text(const std::string& text) {
  if (text.find('\0') != std::string::npos) return false;
  try {
    (void)nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

void check_depth(const std::string& text) {
  std::size_t depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > deepest)
        throw bad_value("body", "nested deeper than " + std::to_string(deepest) + " levels");
    } else if (c == ']' || c == '}') {
      if (depth > 0) --depth;
    }
  }
}

}  // namespace

std::string read_body(const httplib::Request& request, const httplib::ContentReader& reader,
                      std::size_t limit) {
  std::string body;
  const auto announced = request.get_header_value<std::uint64_t>("Content-Length");
  if (announced == 0 && !request.has_header("Transfer-Encoding")) return body;
  const Error too_large("too_large", "at most " + std::to_string(limit) + " bytes", "body");
  if (announced > limit) throw too_large;
  // Multipart bodies would be taken apart by the library; nothing here takes them.
  if (request.is_multipart_form_data()) throw bad_value("Content-Type", "multipart is not taken");
  std::size_t size = 0;
  const bool whole = reader([&](const char* data, std::size_t length) {
    size += length;
    if (size <= limit) body.append(data, length);
    return size <= limit;
  });
  if (size > limit) throw too_large;
  if (!whole) throw bad_value("body", "the body cannot be read");
  return body;
}

void check_text(const httplib::Request& request) {
  if (!valid_text(request.path)) throw not_found("", "there is nothing at this address");
  for (const auto& [name, value] : request.params)
    if (!valid_text(name) || !valid_text(value)) throw bad_value("query", "must be UTF-8 text");
}

nlohmann::json parse_json(const std::string& text) {
  check_depth(text);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    std::string reason = error.what();
    reason = reason.substr(0, 300);  // the message quotes what was read last
    throw bad_value("body", "no valid JSON: " + reason);
  }
}

void check_keys(const nlohmann::json& object, std::initializer_list<const char*> known) {
  if (!object.is_object()) throw bad_value("body", "must be a JSON object");
  for (const auto& [key, value] : object.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    std::string names;
    for (const auto* name : known) names += (names.empty() ? "" : ", ") + std::string(name);
    throw bad_value(key, "is not known; known are " + names);
  }
}

double number_in_query(const httplib::Request& request, const std::string& name, double low,
                       double high, double otherwise) {
  if (!request.has_param(name)) return otherwise;
  const auto text = request.get_param_value(name);
  double value = 0.0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = failure == std::errc{} && end == text.data() + text.size();
  if (!number || !std::isfinite(value) || value < low || value > high)
    throw bad_value(name, "must be a number from " + nlohmann::json(low).dump() + " to " +
                              nlohmann::json(high).dump());
  return value;
}

std::string text_in(const nlohmann::json& body, const char* key, const std::string& otherwise) {
  if (!body.contains(key) || body.at(key).is_null()) return otherwise;
  if (!body.at(key).is_string()) throw bad_value(key, "must be a text");
  return body.at(key).get<std::string>();
}

}  // namespace penumbra::server::http
