// Zip archives of scenes: unpacked inside their folder, or refused.
#include "server/http/scene_upload.h"
#include "tests/fuzz/target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace penumbra;
  static const fuzz::Folder folder;
  fuzz::refuse_only_with({"unreadable"}, [&] {
    server::http::unpack(fuzz::text_of(data, size), folder.path() / "inside");
  });
  // Nothing may stand beside the folder that was given.
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    if (entry.path().filename() != "inside") std::abort();
  std::filesystem::remove_all(folder.path() / "inside");
  return 0;
}
