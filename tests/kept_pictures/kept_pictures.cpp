#include "tests/kept_pictures/kept_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

#include "scenes/picture_io.h"

namespace penumbra::tests {
namespace {

/// The last two pictures that the running test compared.
struct Pair {
  std::string test;  ///< asked for beforehand: while a failure is reported, GoogleTest holds a lock
  Image8 picture;
  Image8 truth;
};

Pair& last_pair() {
  static Pair pair;
  return pair;
}

std::filesystem::path failures_folder() {
  const char* named = std::getenv("PENUMBRA_FAILURES");
  return named ? std::filesystem::path(named)
               : std::filesystem::path(PENUMBRA_BINARY_DIR) / "failures";
}

std::string name_of_test() {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string name =
      test ? std::string(test->test_suite_name()) + "." + test->name() : std::string("outside");
  std::replace(name.begin(), name.end(), '/', '-');
  return name;
}

/// Writes the pair, and forgets it: several expectations about one comparison keep it once.
void keep(Pair& pair) {
  static int number = 0;
  const auto stem = failures_folder() / (pair.test + "-" + std::to_string(++number));
  std::filesystem::create_directories(failures_folder());
  const auto write = [&](const char* what, const Image8& image) {
    const std::filesystem::path file = stem.string() + "-" + what + ".png";
    scenes::write_picture(file, image);
    std::cout << what << ": " << file.string() << std::endl;
  };
  write("picture", pair.picture);
  write("truth", pair.truth);
  if (pair.picture.width == pair.truth.width && pair.picture.height == pair.truth.height)
    write("error", metrics::error_map(pair.picture, pair.truth));
  pair = {};
}

class Keeper : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override { last_pair() = {}; }
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (result.failed() && !last_pair().picture.empty()) keep(last_pair());
  }
};

/// Remembers the pair for the expectation that follows.
void note(const Image8& picture, const Image8& truth) {
  static const bool listening = [] {
    testing::UnitTest::GetInstance()->listeners().Append(new Keeper);  // which owns it
    return true;
  }();
  static_cast<void>(listening);
  last_pair() = {name_of_test(), picture, truth};
}

std::uint8_t byte_of(float value) {
  if (!std::isfinite(value)) return 255;
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

/// Of three channels or more the first three, otherwise the first as grey; no finite number is red.
Image8 shown(const ImageF& image) {
  Image8 out(image.width, image.height, 4, 255);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    const float* from = &image.pixels[i * image.channels];
    for (std::uint32_t c = 0; c < 3; ++c)
      out.pixels[4 * i + c] = byte_of(from[image.channels >= 3 ? c : 0]);
    if (!std::isfinite(from[0])) out.pixels[4 * i + 1] = out.pixels[4 * i + 2] = 0;
  }
  return out;
}

template <class T>
testing::AssertionResult compared(const Image<T>& picture, const Image<T>& truth) {
  if (picture.width != truth.width || picture.height != truth.height ||
      picture.channels != truth.channels)
    return testing::AssertionFailure()
           << picture.width << "x" << picture.height << "x" << picture.channels << " is not "
           << truth.width << "x" << truth.height << "x" << truth.channels;
  std::size_t different = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i)
    if (picture.pixels[i] != truth.pixels[i] && different++ == 0) first = i;
  if (different == 0) return testing::AssertionSuccess();
  const std::size_t pixel = first / truth.channels;
  return testing::AssertionFailure()
         << different << " of " << truth.pixels.size() << " values differ, first at ("
         << pixel % truth.width << ", " << pixel / truth.width
         << "): " << static_cast<double>(picture.pixels[first]) << ", not "
         << static_cast<double>(truth.pixels[first]);
}

}  // namespace

double rms_y(const Image8& picture, const Image8& truth) {
  note(picture, truth);
  return metrics::rms_y(picture, truth);
}

metrics::VisibilityError visibility_error(const ImageF& visibility, const ImageF& truth,
                                          const ImageF& judged) {
  note(shown(visibility), shown(truth));
  return metrics::visibility_error(visibility, truth, judged);
}

testing::AssertionResult same(const Image8& picture, const Image8& truth) {
  note(picture, truth);
  return compared(picture, truth);
}

testing::AssertionResult same(const ImageF& picture, const ImageF& truth) {
  note(shown(picture), shown(truth));
  return compared(picture, truth);
}

}  // namespace penumbra::tests
