#include "renderer/frame/parameter_glsl.h"

#include <algorithm>
#include <bit>
#include <iomanip>
#include <sstream>

#include "renderer/shaders/shader_types.h"

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

/// Of ParameterBlock.
struct Member {
  std::string name;
  bool real;
};

std::string declaration(const Member& member) {
  return (member.real ? "float " : "int ") + member.name + ";\n";
}

/// How many a vertex stage passes, each a word; the rest is read from the block.
std::size_t passed_words(const std::vector<Member>& block) {
  return std::min<std::size_t>(block.size(), shader::passed_parameters);
}

std::string words(const char* direction, const std::vector<Member>& block) {
  return "layout(location = " + std::to_string(shader::parameter_location) + ") flat " + direction +
         " uvec4 parameter_words[" + std::to_string((passed_words(block) + 3) / 4) + "];\n";
}

std::string word(std::size_t i) {
  return "parameter_words[" + std::to_string(i / 4) + "][" + std::to_string(i % 4) + "]";
}

std::string inputs(const std::vector<Member>& block) {
  std::string text = words("in", block);
  for (std::size_t i = 0; i < passed_words(block); ++i) {
    const Member& member = block[i];
    text += std::string(member.real ? "float" : "int") + " passed_" + member.name + " = " +
            (member.real ? "uintBitsToFloat(" : "int(") + word(i) + ");\n#define " + member.name +
            " passed_" + member.name + "\n";
  }
  return text;
}

std::string passing(const std::vector<Member>& block) {
  std::string text = words("out", block) + "#define PASS_PARAMETERS";
  for (std::size_t i = 0; i < passed_words(block); ++i)
    text += " " + word(i) + " = " + (block[i].real ? "floatBitsToUint(" : "uint(") + block[i].name +
            ");";
  return text + "\n";
}

}  // namespace

std::string parameter_declarations(const std::vector<Parameter>& declared,
                                   const ParameterValues& values) {
  std::ostringstream constants;
  std::vector<Member> block;
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
      block.push_back({name, real});
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
  if (block.empty()) return text;
  text += "layout(std430) readonly buffer ParameterBlock {\n";
  for (const Member& member : block) text += declaration(member);
  text += "};\n#ifdef CONSTANTS_FROM_VERTEX\n#ifdef FRAGMENT_STAGE\n" + inputs(block);
  text += "#else\n" + passing(block) + "#endif\n#endif\n";
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
