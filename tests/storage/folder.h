#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

namespace penumbra::server {

/// A folder of its own for a test, gone at the end.
struct TemporaryFolder {
  std::filesystem::path path;

  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "penumbra-XXXXXX").string();
    path = ::mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace penumbra::server
