#include "renderer/frame/rounds.h"

#include <algorithm>

namespace penumbra {

std::vector<PointRange> rounds_of(std::uint32_t light_samples, bool bounded) {
  std::vector<PointRange> rounds;
  std::uint32_t done = 0;
  while (done < light_samples) {
    std::uint32_t next =
        bounded ? std::clamp(done, least_independent, most_round_points) : most_round_points;
    // What is left over stays independent, or is drawn with the rest.
    if (light_samples - done < next + least_independent) next = light_samples - done;
    rounds.push_back({done, next});
    done += next;
  }
  return rounds;
}

}  // namespace penumbra
