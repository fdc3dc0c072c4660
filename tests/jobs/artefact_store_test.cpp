#include "server/jobs/artefact_store.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "server/jobs/durable_file.h"
#include "tests/jobs/temporary_folder.h"

namespace penumbra::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uint64_t plenty = 1u << 30;

std::string id_of(char digit) {
  return std::string(32, digit);
}

fs::path file_of(const fs::path& store, const std::string& id, const std::string& name) {
  return store / id.substr(0, 2) / id / name;
}

TEST(ArtefactStore, gives_back_what_was_put_also_after_a_restart) {
  const TemporaryFolder folder;
  {
    ArtefactStore store(folder.path(), plenty);
    store.put(id_of('a'), {{"n", 1}}, {{"image.png", "bytes"}});
    store.put(id_of('a'), {{"n", 2}}, {{"error.png", "more"}});
    EXPECT_EQ(*store.read(id_of('a'), "image.png"), "bytes");
  }
  ArtefactStore store(folder.path(), plenty);
  EXPECT_EQ(store.find(id_of('a')).at("n"), 2);
  EXPECT_EQ(*store.read(id_of('a'), "image.png"), "bytes");
  EXPECT_EQ(*store.read(id_of('a'), "error.png"), "more");
  EXPECT_EQ(store.read(id_of('a'), "image.exr"), nullptr);
  EXPECT_TRUE(store.find(id_of('b')).is_null());
}

TEST(ArtefactStore, never_gives_out_an_altered_file) {
  const TemporaryFolder folder;
  { ArtefactStore(folder.path(), plenty).put(id_of('a'), {{"n", 1}}, {{"image.png", "bytes"}}); }
  std::ofstream(file_of(folder.path(), id_of('a'), "image.png")) << "bytez";
  ArtefactStore store(folder.path(), plenty);
  EXPECT_EQ(store.read(id_of('a'), "image.png"), nullptr);
  EXPECT_FALSE(store.has(id_of('a'), "image.png"));
  EXPECT_EQ(store.statistics().damaged, 1u);

  // Drawn again it is fine again.
  store.put(id_of('a'), {{"n", 1}}, {{"image.png", "bytes"}});
  EXPECT_EQ(*store.read(id_of('a'), "image.png"), "bytes");
}

TEST(ArtefactStore, never_gives_out_a_truncated_file) {
  const TemporaryFolder folder;
  { ArtefactStore(folder.path(), plenty).put(id_of('a'), {{"n", 1}}, {{"image.png", "bytes"}}); }
  fs::resize_file(file_of(folder.path(), id_of('a'), "image.png"), 3);
  ArtefactStore store(folder.path(), plenty);
  EXPECT_EQ(store.read(id_of('a'), "image.png"), nullptr);
}

TEST(ArtefactStore, forgets_a_render_whose_record_was_altered) {
  const TemporaryFolder folder;
  { ArtefactStore(folder.path(), plenty).put(id_of('a'), {{"n", 1}}, {{"image.png", "bytes"}}); }
  const fs::path record = file_of(folder.path(), id_of('a'), "record.json");
  std::string text = *read_whole(record);
  text.replace(text.find("\"n\":1"), 5, "\"n\":2");
  std::ofstream(record) << text;
  ArtefactStore store(folder.path(), plenty);
  EXPECT_TRUE(store.find(id_of('a')).is_null());
  EXPECT_FALSE(fs::exists(record));
}

TEST(ArtefactStore, drops_the_least_recently_used_beyond_its_cap) {
  const TemporaryFolder folder;
  const std::string kilobytes(20000, 'x');
  ArtefactStore store(folder.path(), 50000);
  store.put(id_of('a'), {}, {{"image.png", kilobytes}});
  store.put(id_of('b'), {}, {{"image.png", kilobytes}});
  EXPECT_NE(store.read(id_of('a'), "image.png"), nullptr);  // now b is the older one
  store.put(id_of('c'), {}, {{"image.png", kilobytes}});
  EXPECT_TRUE(store.find(id_of('b')).is_null());
  EXPECT_FALSE(fs::exists(file_of(folder.path(), id_of('b'), "record.json")));
  EXPECT_NE(store.read(id_of('a'), "image.png"), nullptr);
  EXPECT_NE(store.read(id_of('c'), "image.png"), nullptr);
  EXPECT_LE(store.statistics().bytes, 50000u);
  EXPECT_EQ(store.statistics().evicted, 1u);
}

TEST(ArtefactStore, sweeps_what_a_dead_writer_left_and_leaves_a_living_one_alone) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "new");
  // Process ids end below 2^22 on Linux: this writer cannot live.
  std::ofstream(folder.path() / "new" / "99999999-1") << "half";
  const fs::path mine = folder.path() / "new" / (std::to_string(::getpid()) + "-77");
  std::ofstream(mine) << "half";
  ArtefactStore store(folder.path(), plenty);
  EXPECT_FALSE(fs::exists(folder.path() / "new" / "99999999-1"));
  EXPECT_TRUE(fs::exists(mine));
}

TEST(ArtefactStore, delivers_although_the_disk_takes_nothing) {
  const TemporaryFolder folder;
  ArtefactStore store(folder.path(), plenty);
  // A file where the shelf's folder would be: no write can succeed, also not for root.
  std::ofstream(folder.path() / "aa") << "in the way";
  store.put(id_of('a'), {{"n", 1}}, {{"image.png", "bytes"}});
  EXPECT_EQ(store.statistics().write_failures, 1u);
  EXPECT_EQ(*store.read(id_of('a'), "image.png"), "bytes");
  EXPECT_EQ(store.find(id_of('a')).at("n"), 1);
}

TEST(ArtefactStore, sees_what_another_program_put_into_the_same_folder) {
  const TemporaryFolder folder;
  ArtefactStore mine(folder.path(), plenty);
  ArtefactStore(folder.path(), plenty).put(id_of('d'), {{"n", 4}}, {{"image.png", "theirs"}});
  EXPECT_EQ(*mine.read(id_of('d'), "image.png"), "theirs");
}

}  // namespace
}  // namespace penumbra::server
