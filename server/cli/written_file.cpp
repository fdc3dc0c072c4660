#include "server/cli/written_file.h"

#include <fstream>

#include "renderer/error.h"

namespace penumbra::server::cli {

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw Error("unwritable", "cannot write " + path.string());
}

}  // namespace penumbra::server::cli
