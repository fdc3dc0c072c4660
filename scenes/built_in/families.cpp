#include <charconv>

#include "renderer/error.h"
#include "scenes/built_in/built_in.h"

namespace penumbra::scenes {

const std::vector<SceneFamily>& scene_families() {
  static const std::vector<SceneFamily> families = {
      {"sweep:", "sweep:OxTxL", "O objects of T triangles under L lights", make_sweep},
      {"fleet:", "fleet:N", "N of the aircraft", make_named_fleet}};
  return families;
}

std::vector<int> numbers_of(const std::string& name, const std::string& prefix, std::size_t count,
                            const Error& error) {
  if (name.rfind(prefix, 0) != 0) throw error;
  std::vector<int> values(count);
  const char* at = name.data() + prefix.size();
  const char* end = name.data() + name.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto [stop, state] = std::from_chars(at, end, values[i]);
    if (state != std::errc() || stop == at) throw error;
    if (i + 1 < count ? (stop == end || *stop != 'x') : stop != end) throw error;
    at = stop + 1;
  }
  return values;
}

}  // namespace penumbra::scenes
