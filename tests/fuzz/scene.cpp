// Scene documents (schema/scene.schema.json).
#include "scenes/library.h"
#include "tests/fuzz/target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace penumbra;
  static const fuzz::Folder folder;
  const auto file = folder.write("x.json", fuzz::text_of(data, size));
  fuzz::refuse_only_with({"unreadable", "unsupported"},
                         [&] { validate(*scenes::load(file.string())); });
  return 0;
}
