#include "renderer/reference/sample_classes.h"

#include <algorithm>
#include <numeric>

namespace penumbra::reference {

SampleClasses::SampleClasses(std::vector<std::uint32_t> counts, std::uint32_t capacity)
    : counts_(std::move(counts)), capacity_(capacity) {}

std::vector<SampleList::Range> SampleClasses::ranges(std::uint32_t first, std::uint32_t end) const {
  std::vector<SampleList::Range> ranges;
  for (std::uint32_t set = 0; set < counts_.size() / class_count; ++set) {
    const auto own = counts_.begin() + static_cast<std::ptrdiff_t>(set * class_count);
    const std::uint32_t before = std::accumulate(own, own + first, std::uint32_t{0});
    const std::uint32_t count = std::accumulate(own + first, own + end, std::uint32_t{0});
    ranges.push_back({set, set * capacity_ + before, count});
  }
  return ranges;
}

std::uint64_t SampleClasses::places(std::uint32_t longest) const {
  std::uint64_t places = 0;
  for (std::uint32_t kind = 1; kind <= longest; ++kind)
    for (const SampleList::Range& range : ranges(kind, kind + 1))
      places += std::uint64_t{kind} * range.count;
  return places;
}

std::vector<SampleClasses::Chunk> SampleClasses::chunks(std::uint32_t longest,
                                                        std::uint32_t most) const {
  std::vector<Chunk> chunks;
  std::uint32_t slot = 0;
  for (std::uint32_t set = 0; set < counts_.size() / class_count; ++set) {
    std::uint32_t room = 0;
    for (std::uint32_t kind = 1; kind <= longest; ++kind) {
      SampleList::Range rest = ranges(kind, kind + 1)[set];
      while (rest.count > 0) {
        if (room < kind) {
          chunks.push_back({{set, rest.first, 0}, slot});
          room = most;
        }
        const std::uint32_t taken = std::min(rest.count, room / kind);
        chunks.back().range.count += taken;
        room -= taken * kind;
        rest.first += taken;
        rest.count -= taken;
        slot += taken;
      }
    }
  }
  return chunks;
}

}  // namespace penumbra::reference
