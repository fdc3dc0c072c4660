#include <dlfcn.h>

#include <filesystem>

#include "renderer/error.h"
#include "scenes/formats/picture_formats.h"

namespace penumbra::scenes {
namespace {

namespace fs = std::filesystem;

const PictureFormats& load() {
  const fs::path built = PENUMBRA_FORMATS;
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown).parent_path();
  std::string reason;
  for (const fs::path& folder : {program, program / "../lib/penumbra", built.parent_path()}) {
    const fs::path file = folder / built.filename();
    if (!fs::exists(file, unknown)) continue;
    void* library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    using Give = const PictureFormats* (*)();
    const auto give = library == nullptr
                          ? nullptr
                          : reinterpret_cast<Give>(::dlsym(library, "penumbra_picture_formats"));
    if (give != nullptr) return *give();
    reason = std::string(": ") + ::dlerror();
  }
  throw Error("internal", "pictures other than PNG need " + built.filename().string() +
                              ", which cannot be loaded from the program's folder" + reason);
}

}  // namespace

const PictureFormats& picture_formats() {
  static const PictureFormats& loaded = load();
  return loaded;
}

}  // namespace penumbra::scenes
