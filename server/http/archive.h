#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>

struct zip;

namespace penumbra::server::http {

/// A zip archive that is written to a file: what it holds is read only when it is finished, so that
/// large files pass through little memory. The same content gives the same bytes. Throws Error
/// `internal`.
class ZipWriter {
 public:
  explicit ZipWriter(const std::filesystem::path& archive);
  ~ZipWriter();
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;

  void add_text(const std::string& name, std::string text);
  /// The file must stay where it is until finish().
  void add_file(const std::string& name, const std::filesystem::path& file);

  /// Writes the archive under its name.
  void finish();

 private:
  void describe(std::int64_t index, const std::string& name, bool large);

  struct zip* handle = nullptr;
  std::deque<std::string> texts;  ///< deque: they never move
};

}  // namespace penumbra::server::http
