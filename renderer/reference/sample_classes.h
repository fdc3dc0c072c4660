#pragma once

#include <cstdint>
#include <vector>

#include "renderer/frame/sample_list.h"
#include "renderer/shaders/shader_types.h"

namespace penumbra::reference {

inline constexpr auto class_count = static_cast<std::uint32_t>(shader::sample_classes);

/// Where a list has the samples of each class (shader_types.h), and what their lists of occluders
/// take. The list is ordered by places in pixels and then by classes.
class SampleClasses {
 public:
  /// `counts` of samples, class after class for each place in a pixel, of which there is room for
  /// `capacity` in the list.
  SampleClasses(std::vector<std::uint32_t> counts, std::uint32_t capacity);

  /// The samples of classes from `first` to before `end`: a range for each place in a pixel.
  std::vector<SampleList::Range> ranges(std::uint32_t first, std::uint32_t end) const;
  /// Occluders of all samples in penumbrae that have at most `longest`.
  std::uint64_t places(std::uint32_t longest) const;

  /// Part of these samples; `slot` of the first among all of them.
  struct Chunk {
    SampleList::Range range;
    std::uint32_t slot;
  };
  /// All of them, in parts with at most `most` occluders together.
  std::vector<Chunk> chunks(std::uint32_t longest, std::uint32_t most) const;

 private:
  std::vector<std::uint32_t> counts_;
  std::uint32_t capacity_;
};

}  // namespace penumbra::reference
