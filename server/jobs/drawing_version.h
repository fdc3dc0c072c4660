#pragma once

#include <string>

namespace penumbra::server {

/// The renderer's version and a digest of everything that pictures and measurements are computed
/// with: the sources of renderer/ and techniques/, and what encodes and judges. Part of every
/// render's identity, so that no cache outlives a change of the program.
std::string drawing_version();

}  // namespace penumbra::server
