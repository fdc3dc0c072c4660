#include "renderer/frame/sample_list.h"

namespace penumbra {

void dispatch_range(vulkan::Commands& commands, const SampleList::Range& range, SampleWork work) {
  if (range.count == 0) return;
  work.first = range.first;
  work.count = range.count;
  work.set = range.set;
  commands.constants(work);
  // Devices need not take more than 65,535 groups along one axis.
  constexpr std::uint32_t longest = 16384;
  const std::uint32_t groups = (range.count + 63) / 64;
  const std::uint32_t rows = (groups + longest - 1) / longest;
  commands.dispatch((groups + rows - 1) / rows, rows);
}

void dispatch_all(vulkan::Commands& commands, std::uint32_t width, std::uint32_t height,
                  std::uint32_t side, SampleWork work) {
  commands.constants(work);
  commands.dispatch((width / side + 7) / 8, (height / side + 7) / 8);
}

}  // namespace penumbra
