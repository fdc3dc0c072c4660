#include "server/jobs/checkpoint.h"

#include <gmock/gmock.h>

#include <fstream>

#include "scenes/library.h"
#include "server/jobs/task.h"
#include "tests/jobs/temporary_folder.h"

namespace penumbra::server {
namespace {

namespace fs = std::filesystem;

TEST(Checkpoint, keeps_a_state_until_its_picture_is_done) {
  const TemporaryFolder folder;
  Checkpoint first({folder.path() / "checkpoints", 0.0}, "id");
  EXPECT_EQ(first.load(), "");
  first.offer([] { return std::string("half of it"); });
  const Checkpoint second({folder.path() / "checkpoints", 0.0}, "id");
  EXPECT_EQ(second.load(), "half of it");
  EXPECT_EQ(Checkpoint({folder.path() / "checkpoints", 0.0}, "other").load(), "");
  second.remove();
  EXPECT_EQ(first.load(), "");
  EXPECT_TRUE(fs::is_empty(folder.path() / "checkpoints"));
}

TEST(Checkpoint, is_not_read_where_it_was_altered) {
  const TemporaryFolder folder;
  Checkpoint checkpoint({folder.path(), 0.0}, "id");
  checkpoint.offer([] { return std::string("half of it"); });
  std::ofstream(folder.path() / "id.state", std::ios::app) << "!";
  EXPECT_EQ(checkpoint.load(), "");
}

TEST(Checkpoint, is_written_no_more_often_than_asked) {
  const TemporaryFolder folder;
  Checkpoint checkpoint({folder.path(), 3600.0}, "id");
  checkpoint.offer([]() -> std::string { throw std::logic_error("made for nothing"); });
  EXPECT_EQ(checkpoint.load(), "");
}

TEST(Checkpoint, costs_no_picture_where_the_disk_refuses) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "not a folder";
  Checkpoint checkpoint({folder.path() / "file", 0.0}, "id");
  EXPECT_NO_THROW(checkpoint.offer([] { return std::string("half of it"); }));
}

TEST(Checkpoint, is_swept_after_a_week) {
  const TemporaryFolder folder;
  for (const char* id : {"old", "new"})
    Checkpoint({folder.path(), 0.0}, id).offer([] { return std::string("half of it"); });
  fs::last_write_time(folder.path() / "old.state",
                      fs::file_time_type::clock::now() - std::chrono::hours(8 * 24));
  sweep_checkpoints(folder.path());
  EXPECT_EQ(Checkpoint({folder.path(), 0.0}, "old").load(), "");
  EXPECT_EQ(Checkpoint({folder.path(), 0.0}, "new").load(), "half of it");
}

}  // namespace
}  // namespace penumbra::server
