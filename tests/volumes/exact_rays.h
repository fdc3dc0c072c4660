#pragma once

#include <string>
#include <vector>

#include "experiments/stability/exact_rays.h"

/// What volumes and rays on the device are judged by.
namespace penumbra::test {

using experiments::stability::ExactRays;

/// For every pixel of a square picture and every light: 1 lit, 0 shadowed, -1 where no facet faces
/// the light by more than 1e-6 (sine): where the light lies in a facet's plane, either is right.
std::vector<int> exact_visibility(const Scene& scene, const std::string& camera,
                                  std::uint32_t width);

}  // namespace penumbra::test
