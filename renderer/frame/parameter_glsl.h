#pragma once

#include <string>
#include <vector>

#include "renderer/parameters.h"

namespace penumbra {

/// GLSL that declares `parameter_<name>` for every parameter: compile-time constants for variants,
/// members of a uniform block "ParameterBlock" for the others, and `<name>_<choice>` constants for
/// choices, and `parameter_<name>_maximum` for whole numbers. Booleans are int 0 or 1. The chosen
/// value of a variant choice is also a macro, variant_<name>_<choice>, for what constants cannot
/// switch: types, resources, capabilities.
std::string parameter_declarations(const std::vector<Parameter>& declared,
                                   const ParameterValues& values);

/// Content of ParameterBlock, 4 bytes a member in std430-compatible order, padded to 16 bytes.
std::vector<std::uint32_t> parameter_block(const std::vector<Parameter>& declared,
                                           const ParameterValues& values);

}  // namespace penumbra
