#include "server/http/archive.h"

#include <zip.h>

#include "renderer/error.h"

namespace penumbra::server::http {
namespace {

/// Keeps a source of memory until its bytes were read back.
struct Source {
  zip_source_t* handle;
  ~Source() {
    if (handle != nullptr) zip_source_free(handle);
  }
};

[[noreturn]] void fail(const std::string& what) {
  throw Error("internal", "the archive cannot be made: " + what);
}

std::string bytes_of(zip_source_t* source) {
  zip_stat_t stat;
  if (zip_source_open(source) != 0 || zip_source_stat(source, &stat) != 0) fail("no bytes");
  std::string bytes(stat.size, '\0');
  zip_uint64_t done = 0;
  while (done < stat.size) {
    const auto count = zip_source_read(source, bytes.data() + done, stat.size - done);
    if (count <= 0) fail("bytes are missing");
    done += static_cast<zip_uint64_t>(count);
  }
  zip_source_close(source);
  return bytes;
}

}  // namespace

std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files) {
  zip_error_t failure;
  zip_error_init(&failure);
  Source memory{zip_source_buffer_create(nullptr, 0, 0, &failure)};
  if (memory.handle == nullptr) fail(zip_error_strerror(&failure));
  zip_source_keep(memory.handle);
  zip_t* archive = zip_open_from_source(memory.handle, ZIP_TRUNCATE, &failure);
  if (archive == nullptr) fail(zip_error_strerror(&failure));
  for (const auto& [name, text] : files) {
    zip_source_t* content = zip_source_buffer(archive, text.data(), text.size(), 0);
    if (content == nullptr || zip_file_add(archive, name.c_str(), content, ZIP_FL_ENC_UTF_8) < 0) {
      zip_discard(archive);
      fail(name);
    }
  }
  if (zip_close(archive) != 0) {
    const std::string why = zip_strerror(archive);
    zip_discard(archive);
    fail(why);
  }
  return bytes_of(memory.handle);
}

}  // namespace penumbra::server::http
