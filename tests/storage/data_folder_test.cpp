#include "server/storage/data_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "renderer/error.h"
#include "tests/storage/folder.h"

namespace penumbra::server::storage {
namespace {

TEST(DataFolder, IsOwnedByOneAtATime) {
  const TemporaryFolder folder;
  {
    const DataFolder first(folder.path / "data");
    try {
      const DataFolder second(folder.path / "data");
      FAIL() << "the folder was given away twice";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, "conflict");
      EXPECT_EQ(error.field, "data");
    }
  }
  EXPECT_NO_THROW(DataFolder(folder.path / "data"));
}

TEST(DataFolder, IsFreeAgainWhenItsProcessWasKilled) {
  const TemporaryFolder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    const DataFolder held(folder.path / "data");
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_NO_THROW(DataFolder(folder.path / "data"));
}

TEST(DataFolder, IsClosedToOtherPeople) {
  const TemporaryFolder folder;
  const DataFolder data(folder.path / "data");
  struct stat state {};
  ASSERT_EQ(::stat(data.path().c_str(), &state), 0);
  EXPECT_EQ(state.st_mode & 0777, 0700u);
}

TEST(WritingAFile, LeavesNothingButTheFile) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b", 3);
  write_file_durably(folder.path / "file", bytes);
  write_file_durably(folder.path / "file", bytes + bytes);
  EXPECT_EQ(read_file(folder.path / "file"), bytes + bytes);
  const std::filesystem::directory_iterator listing(folder.path);
  EXPECT_EQ(std::distance(begin(listing), end(listing)), 1);
}

TEST(WritingAFile, SaysWhatStoodInItsWayAndLeavesNothing) {
  const TemporaryFolder folder;
  const auto reason = [](const std::filesystem::path& file) {
    try {
      write_file_durably(file, "bytes");
    } catch (const Error& error) {
      return error.code + ": " + error.what();
    }
    return std::string("written");
  };
  const auto missing = folder.path / "missing" / "file";
  EXPECT_THAT(reason(missing), testing::AllOf(testing::StartsWith("storage: cannot create"),
                                              testing::EndsWith("No such file or directory")));
  // A folder of that name can be replaced by no file.
  const auto place = folder.path / "place";
  std::filesystem::create_directories(place / "full");
  EXPECT_THAT(reason(place), testing::StartsWith("storage: cannot rename to " + place.string()));
  const std::filesystem::directory_iterator listing(folder.path);
  EXPECT_EQ(std::distance(begin(listing), end(listing)), 1) << "what was half written is left";
}

}  // namespace
}  // namespace penumbra::server::storage
