#include "server/jobs/artefact_store.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "server/files/durable_file.h"
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
  // Two of about 28,000 bytes in blocks fit, three do not.
  constexpr std::uint64_t cap = 65000;
  ArtefactStore store(folder.path(), cap);
  store.put(id_of('a'), {}, {{"image.png", kilobytes}});
  store.put(id_of('b'), {}, {{"image.png", kilobytes}});
  EXPECT_NE(store.read(id_of('a'), "image.png"), nullptr);  // now b is the older one
  store.put(id_of('c'), {}, {{"image.png", kilobytes}});
  EXPECT_TRUE(store.find(id_of('b')).is_null());
  EXPECT_FALSE(fs::exists(file_of(folder.path(), id_of('b'), "record.json")));
  EXPECT_NE(store.read(id_of('a'), "image.png"), nullptr);
  EXPECT_NE(store.read(id_of('c'), "image.png"), nullptr);
  EXPECT_LE(store.statistics().bytes, cap);
  EXPECT_EQ(store.statistics().evicted, 1u);
}

TEST(ArtefactStore, counts_blocks_not_lengths) {
  const TemporaryFolder folder;
  ArtefactStore store(folder.path(), plenty);
  for (char digit : std::string("0123456789abcdef"))
    store.put(id_of(digit), {{"n", 1}}, {{"image.png", "x"}});
  // As a person would count it.
  std::uint64_t on_disk = 0;
  for (const auto& place : fs::recursive_directory_iterator(folder.path())) {
    struct stat about {};
    ASSERT_EQ(::stat(place.path().c_str(), &about), 0);
    if (place.is_regular_file()) on_disk += static_cast<std::uint64_t>(about.st_blocks) * 512;
  }
  EXPECT_GE(on_disk, 16u * 1024);
  EXPECT_GE(store.statistics().bytes, on_disk);
  ArtefactStore again(folder.path(), plenty);
  EXPECT_EQ(again.statistics().bytes, store.statistics().bytes);
}

TEST(ArtefactStore, bounds_the_number_of_renders_and_of_records_in_memory) {
  const TemporaryFolder folder;
  ArtefactStore store(folder.path(), {.bytes = plenty, .renders = 10, .loaded_records = 3});
  const std::string digits = "0123456789abcdef";
  for (char digit : digits) store.put(id_of(digit), {{"n", digit}}, {{"image.png", "x"}});
  EXPECT_EQ(store.statistics().renders, 10u);
  EXPECT_EQ(store.statistics().loaded, 3u);
  EXPECT_EQ(store.statistics().evicted, 6u);
  for (char digit : digits.substr(6)) {
    EXPECT_EQ(store.find(id_of(digit)).at("n"), digit);
    EXPECT_EQ(*store.read(id_of(digit), "image.png"), "x");
    EXPECT_LE(store.statistics().loaded, 3u);
  }
  EXPECT_TRUE(store.find(id_of('0')).is_null());
  EXPECT_TRUE(fs::is_empty(folder.path() / "new"));
}

TEST(ArtefactStore, knows_a_render_that_was_put_in_the_place_of_another) {
  const TemporaryFolder folder;
  {
    ArtefactStore store(folder.path(), plenty);
    store.put(id_of('a'), {{"n", 1}}, {{"image.png", "mine"}});
    store.put(id_of('b'), {{"n", 2}}, {{"image.png", "other"}});
  }
  const fs::path place = folder.path() / "aa" / id_of('a');
  fs::remove_all(place);
  fs::copy(folder.path() / "bb" / id_of('b'), place, fs::copy_options::recursive);
  ArtefactStore store(folder.path(), plenty);
  EXPECT_TRUE(store.find(id_of('a')).is_null());
  EXPECT_EQ(store.read(id_of('a'), "image.png"), nullptr);
  EXPECT_EQ(store.statistics().damaged, 1u);
  store.put(id_of('a'), {{"n", 1}}, {{"image.png", "mine"}});
  EXPECT_EQ(*store.read(id_of('a'), "image.png"), "mine");
}

TEST(ArtefactStore, gives_all_readers_of_a_large_file_one_copy) {
  const TemporaryFolder folder;
  ArtefactStore store(folder.path(), plenty);
  store.put(id_of('a'), {{"n", 1}}, {{"image.exr", std::string(10 << 20, 'x')}});
  const auto first = store.read(id_of('a'), "image.exr");
  EXPECT_EQ(store.read(id_of('a'), "image.exr"), first);
  EXPECT_EQ(first.use_count(), 1);  // and keeps none itself
}

TEST(ArtefactStore, survives_many_threads_over_few_renders) {
  const TemporaryFolder folder;
  ArtefactStore store(folder.path(), {.bytes = plenty, .renders = 4, .loaded_records = 2});
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 60; ++i) {
        const std::string id = id_of("0123456789"[(i * 7 + t) % 10]);
        if (i % 3 == 0) store.put(id, {{"id", id}}, {{"image.png", id}});
        if (i % 11 == 0) store.forget(id);
        if (const auto bytes = store.read(id, "image.png"); bytes && *bytes != id) ++wrong;
        const json record = store.find(id);
        if (!record.is_null() && record.at("id") != id) ++wrong;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(store.statistics().renders, 4u);
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
