#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace penumbra {

using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;
using ParameterValues = std::map<std::string, ParameterValue>;

enum class ParameterType { boolean, integer, real, choice };
enum class ParameterScale { linear, logarithmic };

/// Some of the choices of a parameter.
struct Choices {
  std::string name;                 ///< of the parameter
  std::vector<std::string> values;  ///< any of these
};

/// One parameter of a technique, declared once. The GLSL names, validation, JSON Schema, web form,
/// README table check and sweep ranges are all derived from this.
struct Parameter {
  std::string name;
  ParameterType type = ParameterType::real;
  ParameterValue default_value;
  double minimum = 0.0;
  double maximum = 1.0;
  ParameterScale scale = ParameterScale::linear;
  std::string unit;                  ///< "m", "texels", "degrees", "" for plain numbers
  std::vector<std::string> choices;  ///< of type choice
  std::string meaning;
  bool variant = false;  ///< GLSL sees a compile-time constant: for loop bounds and code paths
  bool ablates = false;  ///< takes away what the method needs, to show why: no search sets it
  std::optional<Choices> only_with = {};  ///< without one of these it changes nothing

  // For declarations in one line: integer("size", 512, {1, 16384}, "Of the
  // map.").log().in("texels")
  Parameter log() const;                         ///< scale is logarithmic
  Parameter in(const std::string& unit_) const;  ///< unit
  Parameter compiled() const;                    ///< variant
  Parameter ablating() const;                    ///< ablates
};

/// What a number may be, ends included.
struct Range {
  double minimum = 0.0;
  double maximum = 1.0;
};

Parameter integer(const std::string& name, std::int64_t default_value, const Range& range,
                  const std::string& meaning);
Parameter real(const std::string& name, double default_value, const Range& range,
               const std::string& meaning);
Parameter boolean(const std::string& name, bool default_value, const std::string& meaning);
Parameter choice(const std::string& name, const std::string& default_value,
                 std::vector<std::string> choices, const std::string& meaning);

/// Both lists, in order.
std::vector<Parameter> operator+(std::vector<Parameter> first,
                                 const std::vector<Parameter>& second);

/// The value as people write it: "true", "3", "0.25" (shortest that reads back equal), "linear".
std::string to_text(const ParameterValue& value);

/// `given` in the declared type, as complete_parameters converts and checks it.
ParameterValue checked_value(const Parameter& parameter, const ParameterValue& given);

/// Fills in defaults and checks every value. Numbers convert where nothing is lost (3 -> 3.0,
/// 3.0 -> 3, "3" -> 3, "true" -> true). Throws bad_value naming the parameter and what is allowed;
/// a name that is not declared is an error too.
ParameterValues complete_parameters(const std::vector<Parameter>& declared,
                                    const ParameterValues& given);

/// Whether the parameter may change a picture of these values, which may lack defaults.
bool has_effect(const Parameter& parameter, const std::vector<Parameter>& declared,
                const ParameterValues& values);

/// Values of completed parameters. A name or type other than declared is a defect of the caller:
/// std::logic_error.
bool boolean_of(const ParameterValues& values, const std::string& name);
std::int64_t integer_of(const ParameterValues& values, const std::string& name);
double real_of(const ParameterValues& values, const std::string& name);
const std::string& choice_of(const ParameterValues& values, const std::string& name);

}  // namespace penumbra
