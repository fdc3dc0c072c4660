#include "renderer/frame/uncertainty.h"

#include <cmath>

#include "renderer/frame/host_copy.h"

namespace penumbra {
namespace {

constexpr std::uint32_t layers = Uncertainty::scrambles / 4;

/// How much the encoded value of 0..255 grows with a linear one: the slope of IEC 61966-2-1, or of
/// none; nothing grows where the picture is clipped.
float encoding_slope(float linear, bool encodes) {
  if (linear >= 1.0f || linear < 0.0f) return 0.0f;
  if (!encodes) return 255.0f;
  return 255.0f *
         (linear <= 0.0031308f ? 12.92f : 1.055f / 2.4f * std::pow(linear, 1.0f / 2.4f - 1.0f));
}

}  // namespace

Uncertainty::Uncertainty(vulkan::Device& device, vulkan::MemoryLedger& ledger, std::uint32_t width,
                         std::uint32_t height, std::uint32_t side)
    : width_(width), height_(height), side_(side) {
  vulkan::ImageDescription description;
  description.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  description.width = width;
  description.height = height;
  description.layers = layers;
  description.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                      VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  sums_ = {device, ledger, "scramble sums", description};
}

void Uncertainty::clear_sums(vulkan::Commands& commands) const {
  const VkClearColorValue zero{};
  const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, layers};
  vkCmdClearColorImage(commands.handle(), sums_.handle(), VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &all);
}

void Uncertainty::restart() {
  deviations_.assign(std::size_t{width_} * height_, Deviations{});
  points_ = 0.0f;
}

void Uncertainty::begin_round(std::uint32_t points) {
  round_points_ = static_cast<float>(points);
  points_ += round_points_;
}

void Uncertainty::add_light(vulkan::Device& device, const vulkan::Image& light_sum) {
  const ImageF radiance = read_float(device, light_sum, 4);
  std::array<ImageF, layers> sums;
  for (std::uint32_t layer = 0; layer < layers; ++layer)
    sums[layer] = read_float(device, sums_, 4, layer);
  for (std::uint32_t y = 0; y < height_; ++y)
    for (std::uint32_t x = 0; x < width_; ++x) {
      std::array<float, 3> mean{};
      for (std::uint32_t s = 0; s < side_ * side_; ++s)
        for (std::uint32_t c = 0; c < 3; ++c)
          mean[c] += radiance.at(x * side_ + s % side_, y * side_ + s / side_, c) /
                     static_cast<float>(side_ * side_);
      std::array<float, scrambles> seen;
      float total = 0.0f;
      for (std::uint32_t k = 0; k < scrambles; ++k) {
        seen[k] = sums[k / 4].at(x, y, k % 4);
        total += seen[k];
      }
      if (!(total > 0.0f)) continue;
      // The light's colour at this pixel is taken to be alike in all scrambles.
      Deviations& deviations = deviations_[std::size_t{y} * width_ + x];
      for (std::uint32_t c = 0; c < 3; ++c)
        for (std::uint32_t k = 0; k < scrambles; ++k)
          deviations[c][k] +=
              round_points_ * mean[c] * (static_cast<float>(scrambles) * seen[k] / total - 1.0f);
    }
}

ImageF Uncertainty::standard_error(const ImageF& linear, float exposure, bool encodes) const {
  constexpr std::array<float, 3> weights{0.299f, 0.587f, 0.114f};
  ImageF result(width_, height_, 1);
  for (std::size_t p = 0; p < deviations_.size(); ++p) {
    std::array<float, 3> slopes;
    for (std::size_t c = 0; c < 3; ++c)
      slopes[c] = weights[c] * exposure / points_ *
                  encoding_slope(linear.pixels[p * linear.channels + c], encodes);
    double squares = 0.0;
    for (std::uint32_t k = 0; k < scrambles; ++k) {
      double deviation = 0.0;
      for (std::size_t c = 0; c < 3; ++c)
        deviation += static_cast<double>(slopes[c]) * static_cast<double>(deviations_[p][c][k]);
      squares += deviation * deviation;
    }
    // Variance of a scramble, by one less than there are, and of the mean of all.
    result.pixels[p] = static_cast<float>(std::sqrt(squares / (scrambles - 1) / scrambles));
  }
  return result;
}

double root_mean_square(const ImageF& image) {
  double squares = 0.0;
  for (const float value : image.pixels)
    squares += static_cast<double>(value) * static_cast<double>(value);
  return image.pixels.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(image.pixels.size()));
}

}  // namespace penumbra
