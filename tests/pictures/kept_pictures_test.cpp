// What failing picture tests leave behind, seen from outside: the files and the output of a program
// of tests that fail.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "scenes/picture_io.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class KeptPictures : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = fs::temp_directory_path() / "penumbra-kept-XXXXXX";
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Output of the program's tests that match; it must end as `fails` says.
  std::string run(const std::string& filter, bool fails = true) {
    const std::string command = "PENUMBRA_FAILURES='" + (folder_ / "kept").string() + "' '" +
                                FAILING_PICTURE_TEST "' --gtest_filter='" + filter + "' 2>&1";
    std::string output;
    FILE* pipe = ::popen(command.c_str(), "r");
    EXPECT_NE(pipe, nullptr);
    std::array<char, 4096> part;
    for (std::size_t count; (count = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
      output.append(part.data(), count);
    EXPECT_EQ(::pclose(pipe) != 0, fails) << output;
    return output;
  }

  std::set<std::string> kept() const {
    std::set<std::string> names;
    if (fs::exists(folder_ / "kept"))
      for (const auto& entry : fs::directory_iterator(folder_ / "kept"))
        names.insert(entry.path().filename());
    return names;
  }

  Image8 picture(const std::string& name) const {
    return scenes::read_picture(folder_ / "kept" / name);
  }

  fs::path folder_;
};

TEST_F(KeptPictures, AreThePictureTheTruthAndTheirDifference) {
  const std::string output = run("Fails.in_one_pixel");
  const std::string stem = "Fails.in_one_pixel-1-";
  EXPECT_THAT(kept(), testing::UnorderedElementsAre(stem + "picture.png", stem + "truth.png",
                                                    stem + "error.png"));
  for (const std::string& name : kept())
    EXPECT_THAT(output, HasSubstr((folder_ / "kept" / name).string()));
  EXPECT_THAT(output, HasSubstr("3 of 32 values differ, first at (1, 0): 180, not 100"));
  EXPECT_EQ(picture(stem + "picture.png").at(1, 0, 0), 180);
  EXPECT_EQ(picture(stem + "truth.png").at(1, 0, 0), 100);
  // Too bright is red; what is equal is white.
  const Image8 error = picture(stem + "error.png");
  EXPECT_EQ(error.at(1, 0, 0), 255);
  EXPECT_LT(error.at(1, 0, 2), 50);
  for (std::uint32_t c = 0; c < 3; ++c) EXPECT_EQ(error.at(0, 1, c), 255);
}

TEST_F(KeptPictures, AreKeptOnceForEachComparison) {
  run("Fails.in_two_expectations_of_one_comparison");
  EXPECT_EQ(kept().size(), 3u);
}

TEST_F(KeptPictures, ShowVisibilityAsGrey) {
  run("Fails.in_visibility");
  EXPECT_EQ(picture("Fails.in_visibility-1-picture.png").at(1, 1, 0), 0);
  EXPECT_EQ(picture("Fails.in_visibility-1-truth.png").at(1, 1, 0), 255);
}

TEST_F(KeptPictures, AreNotLeftByWhatComparesNoneOrSucceeds) {
  run("Fails.without_a_picture");
  run("Succeeds.*", false);
  EXPECT_THAT(kept(), testing::IsEmpty());
}

}  // namespace
}  // namespace penumbra
