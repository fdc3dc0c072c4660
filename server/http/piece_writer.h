#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "renderer/error.h"

namespace penumbra::server::http {

/// A file that is written in large pieces.
class PieceWriter {
 public:
  explicit PieceWriter(const std::filesystem::path& file)
      : path(file), stream(file, std::ios::binary) {}

  void add(const std::string& text) {
    buffer += text;
    if (buffer.size() > piece) flush();
  }
  std::string& text() {
    if (buffer.size() > piece) flush();
    return buffer;
  }
  void finish() {
    flush();
    stream.close();
    if (!stream) throw Error("storage", "cannot write " + path.filename().string());
  }

 private:
  static constexpr std::size_t piece = 1 << 20;

  void flush() {
    stream.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    buffer.clear();
  }

  std::filesystem::path path;
  std::ofstream stream;
  std::string buffer;
};

}  // namespace penumbra::server::http
