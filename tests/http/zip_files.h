#pragma once

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

}  // namespace penumbra::server::http
