// A camera over a plane at depth 0, one metre a pixel: everything is known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "renderer/error.h"
#include "renderer/metrics/frame_change.h"

namespace penumbra::metrics {
namespace {

constexpr std::uint32_t width = 8;
constexpr std::uint32_t height = 4;

using Shade = std::function<double(double x, double y)>;

/// The camera stands `moved` m to the right, and sees what `lit` says of points of the plane.
PathFrame frame(double moved, const Shade& lit, double sample = 0.5) {
  PathFrame result;
  result.points = ImageF(width, height, 4, 1.0f);
  result.visibility = ImageF(width, height, 1);
  result.judged = ImageF(width, height, 1, 1.0f);
  result.sample = sample;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double across = x + sample + moved, down = y + sample;
      result.points.at(x, y, 0) = static_cast<float>(across);
      result.points.at(x, y, 1) = static_cast<float>(down);
      result.points.at(x, y, 2) = 0.0f;
      result.visibility.at(x, y, 0) = static_cast<float>(lit(across, down));
    }
  }
  glm::dmat4& clip = result.clip_from_world;
  clip = glm::dmat4(1.0);
  clip[0][0] = 2.0 / width;
  clip[1][1] = 2.0 / height;
  clip[3] = glm::dvec4(-1.0 - moved * 2.0 / width, -1.0, 0.0, 1.0);
  return result;
}

double stripes(double x, double) {
  return std::fmod(std::floor(x), 2.0) == 0.0 ? 1.0 : 0.25;
}

FrameChange change(std::vector<PathFrame> frames) {
  FrameChange result;
  for (PathFrame& each : frames) result.add(std::move(each));
  return result;
}

TEST(FrameChange, IsNoneWhereShadowsStayOnTheirSurfaces) {
  for (const double sample : {0.5, 0.75, 0.625}) {
    const FrameChange result =
        change({frame(0, stripes, sample), frame(3, stripes, sample), frame(2, stripes, sample)});
    EXPECT_EQ(result.points(), (width - 3 + width - 1) * height);
    EXPECT_EQ(result.mean_square(), 0.0);
  }
}

TEST(FrameChange, IsWhatPointsChangeBy) {
  // Stripes that go with the camera: each point changes from 1 to 0.25 or back.
  const auto follow = [](double moved) {
    return frame(moved, [moved](double x, double y) { return stripes(x - moved, y); });
  };
  EXPECT_DOUBLE_EQ(change({follow(0), follow(1)}).mean_square(), 0.75 * 0.75);
  EXPECT_DOUBLE_EQ(change({follow(0), follow(2)}).mean_square(), 0.0);
  EXPECT_DOUBLE_EQ(frame_difference(change({follow(0), follow(1)}),
                                    change({frame(0, stripes), frame(1, stripes)})),
                   0.75);
  EXPECT_EQ(frame_difference(change({frame(0, stripes), frame(1, stripes)}),
                             change({follow(0), follow(1)})),
            0.0);
}

TEST(FrameChange, BordersThatStayChangeNothingWhereverSamplesFall) {
  constexpr int places = 20;
  for (int i = 0; i < places; ++i) {
    const double border = 4.0 + (i + 0.5) / places;
    const auto half = [&](double x, double) { return x < border ? 1.0 : 0.0; };
    for (const double moved : {0.05, 0.5, 1.3}) {
      const FrameChange result = change({frame(0, half), frame(moved, half)});
      EXPECT_EQ(result.mean_square(), 0.0);
      EXPECT_EQ(result.points(), (width - std::ceil(moved)) * height);
    }
  }
  // A border that moves with the camera by two and a half pixels leaves what two samples explain.
  const auto moving = [](double moved) {
    return frame(moved, [=](double x, double) { return x < 2.2 + moved ? 1.0 : 0.0; });
  };
  const FrameChange result = change({moving(0), moving(2.5)});
  EXPECT_DOUBLE_EQ(result.mean_square(), 2.0 / (width - 3));
}

TEST(FrameChange, LeavesOutBackgroundWhatIsNotJudgedAndWhatWasHidden) {
  PathFrame sky = frame(0, stripes);
  sky.points.at(2, 1, 3) = 0.0f;
  EXPECT_EQ(change({frame(0, stripes), sky}).points(), width * height - 1);
  EXPECT_EQ(change({sky, frame(0, stripes)}).points(), width * height - 1);
  PathFrame dark = frame(0, stripes);
  dark.judged.at(5, 3, 0) = 0.25f;
  EXPECT_EQ(change({dark, frame(0, stripes)}).points(), width * height - 1);
  // Something three metres to the side was seen there: it is not where this pixel looks now.
  PathFrame hidden = frame(0, stripes);
  hidden.points.at(3, 2, 0) += 3.0f;
  EXPECT_EQ(change({hidden, frame(0, stripes)}).points(), width * height - 1);
}

TEST(FrameChange, CountsWhatIsNoNumberAsTheWorst) {
  PathFrame broken = frame(0, [](double, double) { return 1.0; });
  broken.visibility.at(0, 0, 0) = NAN;
  EXPECT_DOUBLE_EQ(change({frame(0, [](double, double) { return 1.0; }), broken}).mean_square(),
                   1.0 / (width * height));
}

TEST(FrameChange, RefusesFramesOfAnotherSize) {
  FrameChange result;
  result.add(frame(0, stripes));
  PathFrame other;
  other.points = ImageF(2, 2, 4);
  other.visibility = other.judged = ImageF(2, 2, 1);
  EXPECT_THROW(result.add(other), Error);
}

}  // namespace
}  // namespace penumbra::metrics
