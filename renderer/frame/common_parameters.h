#pragma once

#include <vector>

#include "renderer/parameters.h"

namespace penumbra {

/// Parameters that the frame itself reads; every technique has them after its own.
const std::vector<Parameter>& common_parameters();

/// What the parameter `gamma` asks of the frame. Adorjan 2013, appendix A, shows the first four,
/// and in fig. A.7 `textures_encoded_twice`. `input_twice` is its counterpart: all colours are
/// decoded twice, which looks too dark.
struct GammaTreatment {
  int decodes = 1;  ///< times that sRGB decoding is applied to textures' and materials' colours
  bool textures_as_stored = false;  ///< textures are not decoded, whatever else is
  bool encodes =
      true;  ///< the picture is sRGB-encoded; otherwise linear values are stored as they are
};

/// Of completed parameters.
GammaTreatment gamma_treatment(const ParameterValues& values);

}  // namespace penumbra
