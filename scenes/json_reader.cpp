#include "scenes/json_reader.h"

#include <cmath>
#include <sstream>

namespace penumbra::scenes {
namespace {

std::string range_text(double low, double high) {
  std::ostringstream text;
  text << "must be a number in " << low << ".." << high;
  return text.str();
}

double number_of(const nlohmann::json& value, const std::string& path, double low, double high) {
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!(number >= low && number <= high))
    throw unreadable(path + " " + range_text(low, high), path);
  return number;
}

}  // namespace

JsonReader::JsonReader(const nlohmann::json& value_, std::string path_)
    : value(&value_), path(std::move(path_)) {
  if (!value->is_object())
    throw unreadable((path.empty() ? "the document" : path) + " must be an object", path);
}

bool JsonReader::has(const std::string& key) {
  asked.insert(key);
  return value->contains(key);
}

const nlohmann::json& JsonReader::at(const std::string& key) {
  if (!has(key)) fail(key, "is missing");
  return (*value)[key];
}

std::string JsonReader::path_of(const std::string& key) const {
  return path.empty() ? key : path + "." + key;
}

void JsonReader::fail(const std::string& key, const std::string& what) const {
  throw unreadable(path_of(key) + " " + what, path_of(key));
}

void JsonReader::number(const std::string& key, double& out, double low, double high) {
  if (has(key)) out = number_of(at(key), path_of(key), low, high);
}

void JsonReader::number(const std::string& key, float& out, double low, double high) {
  if (has(key)) out = static_cast<float>(number_of(at(key), path_of(key), low, high));
}

void JsonReader::integer(const std::string& key, std::int64_t& out, std::int64_t low,
                         std::int64_t high) {
  if (!has(key)) return;
  const double given =
      number_of(at(key), path_of(key), static_cast<double>(low), static_cast<double>(high));
  if (given != std::floor(given)) fail(key, "must be a whole number");
  out = static_cast<std::int64_t>(given);
}

void JsonReader::boolean(const std::string& key, bool& out) {
  if (!has(key)) return;
  if (!at(key).is_boolean()) fail(key, "must be true or false");
  out = at(key).get<bool>();
}

void JsonReader::text(const std::string& key, std::string& out) {
  if (!has(key)) return;
  if (!at(key).is_string()) fail(key, "must be a text");
  out = at(key).get<std::string>();
}

void JsonReader::vector(const std::string& key, glm::dvec2& out, double low, double high) {
  if (!has(key)) return;
  const auto numbers = read_numbers(at(key), path_of(key), low, high);
  if (numbers.size() != 2) fail(key, "must have two numbers");
  out = {numbers[0], numbers[1]};
}

void JsonReader::vector(const std::string& key, glm::dvec3& out, double low, double high) {
  if (!has(key)) return;
  const auto numbers = read_numbers(at(key), path_of(key), low, high);
  if (numbers.size() != 3) fail(key, "must have three numbers");
  out = {numbers[0], numbers[1], numbers[2]};
}

void JsonReader::color(const std::string& key, glm::vec3& out) {
  glm::dvec3 precise(out);
  vector(key, precise, 0.0, max_intensity);
  if (has(key)) out = glm::vec3(precise);
}

void JsonReader::finish() const {
  for (const auto& [key, ignored] : value->items()) {
    if (asked.count(key) != 0) continue;
    std::string known;
    for (const std::string& name : asked) known += (known.empty() ? "" : ", ") + name;
    fail(key, "is no known key; there are: " + known);
  }
}

std::vector<double> read_numbers(const nlohmann::json& value, const std::string& path, double low,
                                 double high) {
  if (!value.is_array()) throw unreadable(path + " must be a list of numbers", path);
  std::vector<double> numbers;
  numbers.reserve(value.size());
  for (std::size_t i = 0; i < value.size(); ++i) {
    const auto& element = value[i];
    const double number = element.is_number() ? element.get<double>() : NAN;
    if (!(number >= low && number <= high))
      number_of(element, path + "[" + std::to_string(i) + "]", low, high);
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace penumbra::scenes
