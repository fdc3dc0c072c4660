#include "renderer/frame/round_sum.h"

namespace penumbra {
namespace {

template <class Term>
void add_terms(ImageF& sum, const ImageF& like, const Term& term) {
  if (sum.empty()) sum = ImageF(like.width, like.height, like.channels);
  for (std::size_t i = 0; i < like.pixels.size(); ++i) sum.pixels[i] += term(i);
}

}  // namespace

void RoundSum::add(const ImageF& linear, const ImageF& visibility, const ImageF& judged,
                   std::uint32_t points) {
  const auto weight = static_cast<float>(points);
  add_terms(linear_, linear, [&](std::size_t i) { return weight * linear.pixels[i]; });
  add_terms(visibility_, visibility,
            [&](std::size_t i) { return weight * visibility.pixels[i] * judged.pixels[i]; });
  add_terms(judged_, judged, [&](std::size_t i) { return weight * judged.pixels[i]; });
  points_ += weight;
}

ImageF RoundSum::visibility() const {
  ImageF result = visibility_;
  // Where nothing is judged all is visible, as in a single round.
  for (std::size_t i = 0; i < result.pixels.size(); ++i)
    result.pixels[i] = judged_.pixels[i] > 0.0f ? result.pixels[i] / judged_.pixels[i] : 1.0f;
  return result;
}

ImageF RoundSum::mean(ImageF sum, float scale) {
  for (float& value : sum.pixels) value *= scale;
  return sum;
}

}  // namespace penumbra
