#include "study/answer.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "renderer/error.h"

namespace penumbra::study {

namespace {

using nlohmann::json;

constexpr std::size_t max_time_text = 40;  // ISO 8601 with fractions and zone, generously
constexpr int max_count = 1'000'000;

std::string read_uuid(const json& body) {
  const auto value = body.find("answer_id");
  if (value == body.end() || !value->is_string())
    throw bad_value("answer_id", "a UUID is required");
  auto text = value->get<std::string>();
  bool valid = text.size() == 36;
  for (std::size_t i = 0; valid && i < text.size(); ++i) {
    const bool dash = i == 8 || i == 13 || i == 18 || i == 23;
    valid = dash ? text[i] == '-' : std::isxdigit(static_cast<unsigned char>(text[i])) != 0;
    text[i] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[i])));
  }
  if (!valid) throw bad_value("answer_id", "not a UUID");
  return text;
}

/// Whole number in a range; numbers like 3.0 count, since JSON knows one kind of number only.
int read_integer(const json& value, const std::string& field, int low, int high) {
  const std::string range =
      "whole number from " + std::to_string(low) + " to " + std::to_string(high) + " expected";
  if (!value.is_number()) throw bad_value(field, range);
  const double number = value.get<double>();
  if (!(number >= low && number <= high) || std::floor(number) != number) {
    throw bad_value(field, range);
  }
  return static_cast<int>(number);
}

double read_real(const json& value, const std::string& field, double high) {
  if (!value.is_number() || !(value.get<double>() >= 0.0 && value.get<double>() <= high)) {
    throw bad_value(field, "number from 0 to " + std::to_string(high) + " expected");
  }
  return value.get<double>();
}

std::vector<int> read_slots(const json& body, const std::string& field, std::size_t slots, int low,
                            int high) {
  const auto value = body.find(field);
  if (value == body.end() || !value->is_object()) {
    throw bad_value(field, "an object with a number per slot is required");
  }
  std::vector<int> places;
  std::set<std::string> names;
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const std::string name = std::to_string(slot);
    const std::string path = field + "." + name;
    if (!value->contains(name)) throw bad_value(path, "this picture has no place yet");
    places.push_back(read_integer(value->at(name), path, low, high));
    names.insert(name);
  }
  for (const auto& [name, unused] : value->items()) {
    if (!names.contains(name)) throw bad_value(field + "." + name, "the page has no such slot");
  }
  return places;
}

PageSize read_size(const json& value, const std::string& field) {
  if (!value.is_object() || value.size() != 2 || !value.contains("width") ||
      !value.contains("height")) {
    throw bad_value(field, "an object with width and height is expected");
  }
  return {read_real(value.at("width"), field + ".width", 1e6),
          read_real(value.at("height"), field + ".height", 1e6)};
}

std::vector<int> read_order_shown(const json& value, std::size_t slots) {
  if (!value.is_array() || value.size() > slots) {
    throw bad_value("order_shown", "a list of slots is expected");
  }
  std::vector<int> order;
  for (std::size_t i = 0; i < value.size(); ++i) {
    order.push_back(read_integer(value[i], "order_shown[" + std::to_string(i) + "]", 0,
                                 static_cast<int>(slots) - 1));
  }
  return order;
}

/// Reads one optional key; false for an unknown key.
bool read_observation(const std::string& key, const json& value, std::size_t slots,
                      Observations& seen) {
  if (key == "active_ms")
    seen.active_ms = read_real(value, key, max_ms);
  else if (key == "total_ms")
    seen.total_ms = read_real(value, key, max_ms);
  else if (key == "enlargements")
    seen.enlargements = read_integer(value, key, 0, max_count);
  else if (key == "flips")
    seen.flips = read_integer(value, key, 0, max_count);
  else if (key == "turns")
    seen.turns = read_integer(value, key, 0, max_count);
  else if (key == "frames_seen")
    seen.frames_seen = read_integer(value, key, 0, max_count);
  else if (key == "swaps")
    seen.swaps = read_integer(value, key, 0, max_count);
  else if (key == "blurs")
    seen.blurs = read_integer(value, key, 0, max_count);
  else if (key == "load_failures")
    seen.load_failures = read_integer(value, key, 0, max_count);
  else if (key == "order_shown")
    seen.order_shown = read_order_shown(value, slots);
  else if (key == "window")
    seen.window = read_size(value, key);
  else if (key == "screen")
    seen.screen = read_size(value, key);
  else if (key == "device_pixel_ratio")
    seen.device_pixel_ratio = read_real(value, key, 64.0);
  else if (key == "all_same") {
    if (!value.is_boolean()) throw bad_value(key, "true or false expected");
    seen.all_same = value.get<bool>();
  } else if (key == "started_at" || key == "answered_at") {
    if (!value.is_string() || value.get_ref<const std::string&>().size() > max_time_text) {
      throw bad_value(key, "a time as ISO 8601 has it is expected");
    }
    (key == "started_at" ? seen.started_at : seen.answered_at) = value.get<std::string>();
  } else {
    return false;
  }
  return true;
}

}  // namespace

Answer parse_answer(const json& body, const Arm& arm, std::size_t slots, bool practice) {
  if (!body.is_object()) throw bad_value("", "an answer is a JSON object");
  Answer answer;
  answer.answer_id = read_uuid(body);
  const bool numeric = arm.widget == Widget::numeric;
  const std::string wanted = numeric ? "digits" : "shelves";
  if (numeric) {
    answer.digits = read_slots(body, wanted, slots, 1, 9);
    for (const int digit : answer.digits)
      answer.order.push_back(digit_from_best(digit, arm.best_digit));
  } else {
    answer.shelves = read_slots(body, wanted, slots, 0, static_cast<int>(slots) - 1);
    answer.order = answer.shelves;
  }
  if (body.contains("difficulty")) {
    answer.difficulty = read_integer(body.at("difficulty"), "difficulty", 1, 5);
  } else if (!practice) {
    throw bad_value("difficulty", "how hard it was is required: 1 (hard to see) to 5 (easy)");
  }
  for (const auto& [key, value] : body.items()) {
    if (key == "answer_id" || key == wanted || key == "difficulty") continue;
    if (!read_observation(key, value, slots, answer.observations)) {
      throw bad_value(key, "unknown key");
    }
  }
  if (answer.observations.all_same) {
    const auto& order = answer.order;
    if (std::adjacent_find(order.begin(), order.end(), std::not_equal_to<>()) != order.end()) {
      throw bad_value("all_same", "the pictures do not share one place");
    }
  }
  return answer;
}

// Numbers compare by value in nlohmann::json (3 == 3.0), objects without regard to order.
bool same_answer(const json& a, const json& b) {
  return a == b;
}

std::vector<int> doubled_mid_ranks(const std::vector<int>& values) {
  std::vector<int> ranks(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    int below = 0;
    int equal = 0;
    for (const int other : values) {
      below += other < values[i] ? 1 : 0;
      equal += other == values[i] ? 1 : 0;
    }
    ranks[i] = 2 * below + equal + 1;  // mean of below + 1 .. below + equal, doubled
  }
  return ranks;
}

}  // namespace penumbra::study
