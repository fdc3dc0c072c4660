#pragma once

#include <zip.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "server/http/archive.h"
#include "server/storage/data_folder.h"
#include "tests/http/running_server.h"

namespace penumbra::server::http {

/// The bytes of an archive that holds these texts by their names.
inline std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files) {
  const TemporaryFolder folder;
  const auto path = folder.path / "made.zip";
  ZipWriter zip(path);
  for (const auto& [name, text] : files) zip.add_text(name, text);
  zip.finish();
  return storage::read_file(path);
}

/// Files of an archive by name.
inline std::map<std::string, std::string> unpacked(const std::filesystem::path& file) {
  std::map<std::string, std::string> files;
  int failure = 0;
  zip_t* zip = zip_open(file.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &failure);
  if (zip == nullptr) return files;
  for (zip_int64_t i = 0; i < zip_get_num_entries(zip, 0); ++i) {
    zip_stat_t stat;
    zip_stat_index(zip, static_cast<zip_uint64_t>(i), 0, &stat);
    std::string bytes(stat.size, '\0');
    zip_file_t* entry = zip_fopen_index(zip, static_cast<zip_uint64_t>(i), 0);
    EXPECT_EQ(zip_fread(entry, bytes.data(), bytes.size()), static_cast<zip_int64_t>(stat.size));
    EXPECT_EQ(zip_fclose(entry), 0) << stat.name;  // its checksum is right
    files[stat.name] = std::move(bytes);
  }
  zip_discard(zip);
  return files;
}

}  // namespace penumbra::server::http
