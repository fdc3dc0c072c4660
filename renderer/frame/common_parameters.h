#pragma once

#include <vector>

#include "renderer/parameters.h"

namespace penumbra {

/// Parameters that the frame itself reads; every technique has them after its own.
const std::vector<Parameter>& common_parameters();

/// What the parameter `gamma` asks of the frame. Adorjan 2013, appendix A, shows the first four;
/// its fig. A.7 spoils the input the other way, by encoding textures twice, which looks too bright
/// like output_only. `input_twice` decodes all colours twice, which looks too dark.
struct GammaTreatment {
  int decodes = 1;  ///< times that sRGB decoding is applied to textures' and materials' colours
  bool encodes =
      true;  ///< the picture is sRGB-encoded; otherwise linear values are stored as they are
};

/// Of completed parameters.
GammaTreatment gamma_treatment(const ParameterValues& values);

}  // namespace penumbra
