#include "renderer/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "renderer/error.h"

namespace penumbra {
namespace {

/// The whole text as a number, or nothing: "3x", "" and "nan" are no numbers.
template <class T>
std::optional<T> parse(const std::string& text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || rest != end) return std::nullopt;
  return value;
}

/// Doubles hold every integer up to 2^53 and no fraction of those is lost on the way.
constexpr double exact_integers = 9007199254740992.0;

std::optional<std::int64_t> integer_without_loss(double value) {
  if (!(std::abs(value) <= exact_integers) || value != std::trunc(value)) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

std::string shortest(double value) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string allowed(const Parameter& parameter) {
  const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
  const std::string range =
      " from " + shortest(parameter.minimum) + " to " + shortest(parameter.maximum) + unit;
  switch (parameter.type) {
    case ParameterType::boolean:
      return "true or false";
    case ParameterType::integer:
      return "a whole number" + range;
    case ParameterType::real:
      return "a number" + range;
    case ParameterType::choice:
      return "one of " + quoted_list(parameter.choices);
  }
  throw std::logic_error("parameter " + parameter.name + " has an unknown type");
}

std::optional<bool> as_boolean(const ParameterValue& given) {
  if (const bool* value = std::get_if<bool>(&given)) return *value;
  const std::string* text = std::get_if<std::string>(&given);
  if (text && *text == "true") return true;
  if (text && *text == "false") return false;
  return std::nullopt;
}

std::optional<std::int64_t> as_integer(const ParameterValue& given) {
  if (const std::int64_t* value = std::get_if<std::int64_t>(&given)) return *value;
  if (const double* value = std::get_if<double>(&given)) return integer_without_loss(*value);
  if (const std::string* text = std::get_if<std::string>(&given)) {
    if (const auto value = parse<std::int64_t>(*text)) return value;
    if (const auto value = parse<double>(*text)) return integer_without_loss(*value);
  }
  return std::nullopt;
}

std::optional<double> as_real(const ParameterValue& given) {
  std::optional<double> value;
  if (const double* real = std::get_if<double>(&given)) value = *real;
  if (const std::int64_t* integer = std::get_if<std::int64_t>(&given))
    value = static_cast<double>(*integer);
  if (const std::string* text = std::get_if<std::string>(&given)) value = parse<double>(*text);
  // One spelling per value: -0 and 0 must not make two renders of one.
  if (value == 0.0) value = 0.0;
  return value;
}

/// A choice may be spelt with digits, which JSON and people give as a number.
std::optional<std::string> as_choice(const Parameter& parameter, const ParameterValue& given) {
  std::string text;
  if (const std::string* value = std::get_if<std::string>(&given)) text = *value;
  if (const auto* value = std::get_if<std::int64_t>(&given)) text = std::to_string(*value);
  const auto& choices = parameter.choices;
  if (std::find(choices.begin(), choices.end(), text) == choices.end()) return std::nullopt;
  return text;
}

/// The comparison is false for NaN, which no range admits.
bool within(const Parameter& parameter, double value) {
  return parameter.minimum <= value && value <= parameter.maximum;
}

std::optional<ParameterValue> converted(const Parameter& parameter, const ParameterValue& given) {
  switch (parameter.type) {
    case ParameterType::boolean:
      if (const auto value = as_boolean(given)) return *value;
      break;
    case ParameterType::integer:
      if (const auto value = as_integer(given))
        if (within(parameter, static_cast<double>(*value))) return *value;
      break;
    case ParameterType::real:
      if (const auto value = as_real(given))
        if (within(parameter, *value)) return *value;
      break;
    case ParameterType::choice:
      if (const auto value = as_choice(parameter, given)) return *value;
      break;
  }
  return std::nullopt;
}

const ParameterValue& value_of(const ParameterValues& values, const std::string& name) {
  const auto found = values.find(name);
  if (found == values.end()) throw std::logic_error("parameter " + name + " was never declared");
  return found->second;
}

template <class T>
const T& typed(const ParameterValues& values, const std::string& name) {
  const T* value = std::get_if<T>(&value_of(values, name));
  if (!value) throw std::logic_error("parameter " + name + " is read as a type it does not have");
  return *value;
}

}  // namespace

Parameter Parameter::log() const {
  Parameter copy = *this;
  copy.scale = ParameterScale::logarithmic;
  return copy;
}

Parameter Parameter::in(const std::string& unit_) const {
  Parameter copy = *this;
  copy.unit = unit_;
  return copy;
}

Parameter Parameter::compiled() const {
  Parameter copy = *this;
  copy.variant = true;
  return copy;
}

Parameter Parameter::ablating() const {
  Parameter copy = *this;
  copy.ablates = true;
  return copy;
}

Parameter integer(const std::string& name, std::int64_t default_value, const Range& range,
                  const std::string& meaning) {
  return {.name = name,
          .type = ParameterType::integer,
          .default_value = default_value,
          .minimum = range.minimum,
          .maximum = range.maximum,
          .meaning = meaning};
}

Parameter real(const std::string& name, double default_value, const Range& range,
               const std::string& meaning) {
  return {.name = name,
          .type = ParameterType::real,
          .default_value = default_value,
          .minimum = range.minimum,
          .maximum = range.maximum,
          .meaning = meaning};
}

Parameter boolean(const std::string& name, bool default_value, const std::string& meaning) {
  return {.name = name,
          .type = ParameterType::boolean,
          .default_value = default_value,
          .meaning = meaning};
}

Parameter choice(const std::string& name, const std::string& default_value,
                 std::vector<std::string> choices, const std::string& meaning) {
  return {.name = name,
          .type = ParameterType::choice,
          .default_value = default_value,
          .choices = std::move(choices),
          .meaning = meaning};
}

std::vector<Parameter> operator+(std::vector<Parameter> first,
                                 const std::vector<Parameter>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::string to_text(const ParameterValue& value) {
  if (const bool* boolean = std::get_if<bool>(&value)) return *boolean ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const double* real = std::get_if<double>(&value)) return shortest(*real);
  return std::get<std::string>(value);
}

ParameterValue checked_value(const Parameter& parameter, const ParameterValue& given) {
  if (auto value = converted(parameter, given)) return *value;
  throw bad_value(parameter.name, "parameter " + parameter.name + " must be " + allowed(parameter) +
                                      ", not \"" + to_text(given) + "\"");
}

ParameterValues complete_parameters(const std::vector<Parameter>& declared,
                                    const ParameterValues& given) {
  // Refuse undeclared names before any value: a misspelt name is the likelier mistake.
  for (const auto& [name, value] : given) {
    const auto has_name = [&wanted = name](const Parameter& p) { return p.name == wanted; };
    if (std::any_of(declared.begin(), declared.end(), has_name)) continue;
    std::vector<std::string> names;
    for (const Parameter& parameter : declared) names.push_back(parameter.name);
    throw bad_value(name, "there is no parameter " + name +
                              " here; there are: " + (names.empty() ? "none" : quoted_list(names)));
  }
  ParameterValues complete;
  for (const Parameter& parameter : declared) {
    const auto found = given.find(parameter.name);
    complete[parameter.name] =
        checked_value(parameter, found == given.end() ? parameter.default_value : found->second);
  }
  return complete;
}

bool has_effect(const Parameter& parameter, const std::vector<Parameter>& declared,
                const ParameterValues& values) {
  if (!parameter.only_with) return true;
  const auto& [name, choices] = *parameter.only_with;
  const auto is_one = [&needed = choices](const ParameterValue& value) {
    return std::find(needed.begin(), needed.end(), std::get<std::string>(value)) != needed.end();
  };
  if (const auto given = values.find(name); given != values.end()) return is_one(given->second);
  return std::any_of(declared.begin(), declared.end(), [&, &needed = name](const Parameter& other) {
    return other.name == needed && is_one(other.default_value);
  });
}

bool boolean_of(const ParameterValues& values, const std::string& name) {
  return typed<bool>(values, name);
}

std::int64_t integer_of(const ParameterValues& values, const std::string& name) {
  return typed<std::int64_t>(values, name);
}

double real_of(const ParameterValues& values, const std::string& name) {
  return typed<double>(values, name);
}

const std::string& choice_of(const ParameterValues& values, const std::string& name) {
  return typed<std::string>(values, name);
}

}  // namespace penumbra
