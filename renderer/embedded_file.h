#pragma once

#include <span>
#include <string_view>

namespace penumbra {

/// A text file compiled into the program (shaders, presets): a binary can be carried alone.
struct EmbeddedFile {
  std::string_view path;  ///< from the repository's root, forward slashes
  std::string_view text;
};

}  // namespace penumbra
