#include "scenes/import/notes.h"

#include <algorithm>

namespace penumbra::scenes {
namespace {

/// Kinds beyond it are not told: texts that quote the file could be as many as its elements.
constexpr std::size_t most_kinds = 100;

}  // namespace

void Notes::add(const std::string& where, const std::string& what) {
  const auto same =
      std::find_if(kinds.begin(), kinds.end(), [&](const Kind& kind) { return kind.what == what; });
  if (same != kinds.end())
    ++same->count;
  else if (kinds.size() < most_kinds)
    kinds.push_back({where, what, 1});
}

void Notes::write_to(std::vector<std::string>& list) const {
  for (const Kind& kind : kinds)
    list.push_back(
        kind.where + kind.what +
        (kind.count > 1 ? " (and " + std::to_string(kind.count - 1) + " more like it)" : ""));
  if (kinds.size() == most_kinds) list.push_back("there may be more notes than these");
}

}  // namespace penumbra::scenes
