// glTF documents and binaries, as an upload brings them: a scene, or a typed error.
#include "scenes/library.h"
#include "tests/fuzz/target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace penumbra;
  static const fuzz::Folder folder;
  const std::string bytes = fuzz::text_of(data, size);
  const auto file = folder.write(bytes.starts_with("glTF") ? "x.glb" : "x.gltf", bytes);
  fuzz::refuse_only_with({"unreadable", "unsupported"},
                         [&] { validate(*scenes::load(file.string())); });
  return 0;
}
