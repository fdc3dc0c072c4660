#include "server/http/archive.h"

#include <zip.h>

#include "renderer/error.h"

namespace penumbra::server::http {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Error("internal", "the archive cannot be made: " + what);
}

}  // namespace

ZipWriter::ZipWriter(const std::filesystem::path& archive) {
  int failure = 0;
  handle = zip_open(archive.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &failure);
  if (handle == nullptr) {
    zip_error_t error;
    zip_error_init_with_code(&error, failure);
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    fail(why);
  }
}

ZipWriter::~ZipWriter() {
  if (handle != nullptr) zip_discard(handle);
}

void ZipWriter::describe(std::int64_t index, const std::string& name, bool large) {
  if (index < 0) fail(name + ": " + zip_strerror(handle));
  const auto entry = static_cast<zip_uint64_t>(index);
  // Level 1 is three times as fast as the default on tables, which repeat themselves anyway.
  constexpr zip_uint32_t fast = 1;
  constexpr zip_uint32_t usual = 6;
  zip_set_file_compression(handle, entry, ZIP_CM_DEFLATE, large ? fast : usual);
  constexpr std::time_t earliest = 315576000;  // 1980-01-01 12:00 UTC: zip knows no earlier time
  zip_file_set_mtime(handle, entry, earliest, 0);
}

void ZipWriter::add_text(const std::string& name, std::string text) {
  texts.push_back(std::move(text));
  zip_source_t* source = zip_source_buffer(handle, texts.back().data(), texts.back().size(), 0);
  if (source == nullptr) fail(name);
  const auto index = zip_file_add(handle, name.c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) zip_source_free(source);
  describe(index, name, false);
}

void ZipWriter::add_file(const std::string& name, const std::filesystem::path& file) {
  zip_source_t* source = zip_source_file(handle, file.c_str(), 0, -1);
  if (source == nullptr) fail(name);
  const auto index = zip_file_add(handle, name.c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) zip_source_free(source);
  describe(index, name, true);
}

void ZipWriter::finish() {
  if (zip_close(handle) != 0) fail(zip_strerror(handle));
  handle = nullptr;
}

}  // namespace penumbra::server::http
