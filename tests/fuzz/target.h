#pragma once

#include <stdlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>

#include "renderer/error.h"

/// libFuzzer's entry: one input. Sanitizers and uncaught exceptions end the program.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace penumbra::fuzz {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Folder of this process, gone at its end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "penumbra-fuzz-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Runs `action`. Bad input may only be refused by an Error of one of `codes`; any other exception
/// leaves the entry and ends the program.
template <class Action>
void refuse_only_with(std::initializer_list<std::string_view> codes, Action action) {
  try {
    action();
  } catch (const Error& error) {
    if (std::find(codes.begin(), codes.end(), error.code) != codes.end()) return;
    std::fprintf(stderr, "code %s: %s\n", error.code.c_str(), error.what());
    throw;
  }
}

}  // namespace penumbra::fuzz
