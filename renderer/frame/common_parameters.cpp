#include "renderer/frame/common_parameters.h"

#include <stdexcept>
#include <string>

namespace penumbra {

const std::vector<Parameter>& common_parameters() {
  static const std::vector<Parameter> parameters{{
      .name = "gamma",
      .type = ParameterType::choice,
      .default_value = std::string("correct"),
      .choices = {"correct", "off", "input_only", "output_only", "input_twice",
                  "textures_encoded_twice"},
      .meaning = "sRGB handling: correct decodes colours once and encodes the picture; off does "
                 "neither; input_only never encodes (too dark); output_only never decodes (too "
                 "bright); input_twice decodes colours twice (too dark); textures_encoded_twice "
                 "leaves out the decoding of textures alone (too bright where there are any)",
  }};
  return parameters;
}

GammaTreatment gamma_treatment(const ParameterValues& values) {
  const std::string& gamma = choice_of(values, "gamma");
  if (gamma == "correct") return {.decodes = 1, .encodes = true};
  if (gamma == "off") return {.decodes = 0, .encodes = false};
  if (gamma == "input_only") return {.decodes = 1, .encodes = false};
  if (gamma == "output_only") return {.decodes = 0, .encodes = true};
  if (gamma == "input_twice") return {.decodes = 2, .encodes = true};
  if (gamma == "textures_encoded_twice") return {.textures_as_stored = true};
  throw std::logic_error("gamma has a choice without a treatment: " + gamma);
}

}  // namespace penumbra
