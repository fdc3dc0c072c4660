#include "renderer/frame/parameter_glsl.h"

#include <algorithm>
#include <bit>
#include <iomanip>
#include <sstream>

namespace penumbra {
namespace {

std::string identifier(std::string text) {
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

std::int64_t integer_value(const Parameter& parameter, const ParameterValues& values) {
  if (parameter.type == ParameterType::boolean) return boolean_of(values, parameter.name) ? 1 : 0;
  if (parameter.type == ParameterType::integer) return integer_of(values, parameter.name);
  const auto& choices = parameter.choices;
  return std::find(choices.begin(), choices.end(), choice_of(values, parameter.name)) -
         choices.begin();
}

}  // namespace

std::string parameter_declarations(const std::vector<Parameter>& declared,
                                   const ParameterValues& values) {
  std::ostringstream constants;
  std::ostringstream members;
  for (const Parameter& parameter : declared) {
    const bool real = parameter.type == ParameterType::real;
    const std::string name = "parameter_" + identifier(parameter.name);
    for (std::size_t i = 0; i < parameter.choices.size(); ++i)
      constants << "const int " << identifier(parameter.name) << '_'
                << identifier(parameter.choices[i]) << " = " << i << ";\n";
    if (parameter.type == ParameterType::integer)
      constants << "const int " << name
                << "_maximum = " << static_cast<std::int64_t>(parameter.maximum) << ";\n";
    if (!parameter.variant) {
      members << "  " << (real ? "float " : "int ") << name << ";\n";
    } else if (real) {
      constants << "const float " << name << " = float(" << std::setprecision(9)
                << real_of(values, parameter.name) << ");\n";
    } else {
      constants << "const int " << name << " = " << integer_value(parameter, values) << ";\n";
      if (parameter.type == ParameterType::choice)
        constants << "#define variant_" << identifier(parameter.name) << '_'
                  << identifier(choice_of(values, parameter.name)) << '\n';
    }
  }
  std::string text = constants.str();
  if (!members.str().empty())
    text += "layout(std430) readonly buffer ParameterBlock {\n" + members.str() + "};\n";
  return text;
}

std::vector<std::uint32_t> parameter_block(const std::vector<Parameter>& declared,
                                           const ParameterValues& values) {
  std::vector<std::uint32_t> words;
  for (const Parameter& parameter : declared) {
    if (parameter.variant) continue;
    if (parameter.type == ParameterType::real)
      words.push_back(
          std::bit_cast<std::uint32_t>(static_cast<float>(real_of(values, parameter.name))));
    else
      words.push_back(static_cast<std::uint32_t>(integer_value(parameter, values)));
  }
  words.resize(std::max<std::size_t>(4, (words.size() + 3) / 4 * 4));
  return words;
}

}  // namespace penumbra
