#pragma once

#include <string>

namespace penumbra::experiments {

/// Changes whenever a technique's measurements may: a digest of its folder's files, and one of what
/// all techniques share (the renderer and this engine). A change in one folder leaves the results
/// of all other techniques valid.
std::string technique_version(const std::string& id);

}  // namespace penumbra::experiments
