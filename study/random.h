#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace penumbra::study {

/// Random numbers that are the same on every machine: the standard fixes its engines, but not its
/// distributions, so those are spelled out here.
class Random {
 public:
  /// Different `stream` and `index` give unrelated sequences of one seed.
  explicit Random(std::uint64_t seed, std::uint32_t stream = 0, std::uint64_t index = 0) {
    std::seed_seq words{low(seed), high(seed), stream, low(index), high(index)};
    engine.seed(words);
  }

  std::uint64_t bits() { return engine(); }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(engine() >> 11) * 0x1.0p-53; }

  /// Uniform in 0 .. count - 1, without the bias of a plain remainder; count > 0.
  std::size_t below(std::size_t count) {
    const std::uint64_t limit = ~std::uint64_t{0} - ~std::uint64_t{0} % count;
    std::uint64_t value = engine();
    while (value >= limit) value = engine();
    return static_cast<std::size_t>(value % count);
  }

  /// 0 .. count - 1 in random order (Fisher and Yates).
  std::vector<std::size_t> permutation(std::size_t count) {
    std::vector<std::size_t> order(count);
    for (std::size_t i = 0; i < count; ++i) order[i] = i;
    for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[below(i)]);
    return order;
  }

 private:
  static std::uint32_t low(std::uint64_t value) { return static_cast<std::uint32_t>(value); }
  static std::uint32_t high(std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32); }

  std::mt19937_64 engine;
};

}  // namespace penumbra::study
