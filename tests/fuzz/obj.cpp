// An OBJ file and its materials, parted by a line of two percent signs.
#include "scenes/library.h"
#include "tests/fuzz/target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace penumbra;
  static const fuzz::Folder folder;
  const std::string bytes = fuzz::text_of(data, size);
  const std::string parting = "\n%%\n";
  const auto at = bytes.find(parting);
  const auto file = folder.write("x.obj", bytes.substr(0, at));
  folder.write("x.mtl", at == std::string::npos ? "" : bytes.substr(at + parting.size()));
  fuzz::refuse_only_with({"unreadable", "unsupported"},
                         [&] { validate(*scenes::load(file.string())); });
  return 0;
}
