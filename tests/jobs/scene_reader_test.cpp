// Scenes that are loaded for requests, and the process that reads uploads, without the program.
#include "server/jobs/scene_reader.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <set>
#include <thread>

#include "renderer/error.h"
#include "scenes/export.h"
#include "scenes/library.h"
#include "server/jobs/child_process.h"
#include "server/jobs/memory_budget.h"
#include "server/jobs/message.h"
#include "server/jobs/request_scene.h"
#include "tests/jobs/temporary_folder.h"

namespace penumbra::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What run_scene_reader writes, in a process of its own that may take `bytes` more of memory.
json read_by_child(const fs::path& file, std::uint64_t bytes) {
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::_exit(run_scene_reader(file, bytes));
  }
  ::close(ends[1]);
  Message message;
  const Exchange outcome = MessageReader(ends[0]).read(
      message, std::chrono::steady_clock::now() + std::chrono::seconds(60));
  EXPECT_EQ(outcome, Exchange::message);
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  return message.body;
}

TEST(SceneReader, says_what_a_scene_is_and_what_is_wrong_with_it) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "scene.glb";
  scenes::export_glb(*scenes::load("sweep:2x50x1"), file);
  EXPECT_TRUE(read_by_child(file, 1u << 30).at("scene").contains("notes"));
  std::ofstream(folder.path() / "bad.glb") << "glTF no more";
  EXPECT_EQ(read_by_child(folder.path() / "bad.glb", 1u << 30).at("error").at("code"),
            "unreadable");
}

// A limit of addresses says nothing under sanitizers that reserve terabytes of them.
#ifdef __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PENUMBRA_ADDRESSES_ARE_RESERVED
#endif
#endif
#ifndef PENUMBRA_ADDRESSES_ARE_RESERVED
// Suites of this name run before all others: what those leave free in the heap and in the arenas of
// their threads would be the reader's, beside what it may take.
TEST(SceneReaderDeathTest, refuses_a_scene_that_needs_more_memory_than_it_may_take) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "scene.glb";
  const pid_t maker = ::fork();
  if (maker == 0) {
    scenes::export_glb(*scenes::load("sweep:50x100000x1"), file);
    ::_exit(0);
  }
  ::waitpid(maker, nullptr, 0);
  ASSERT_GT(fs::file_size(file), 2u << 20);
  // The importer may notice first that it cannot hold the file.
  const std::string code = read_by_child(file, 1u << 20).at("error").at("code");
  EXPECT_TRUE(code == "unsupported" || code == "unreadable") << code;
}
#endif

TEST(ScenesOfRequests, are_kept_as_long_as_their_bytes_fit) {
  // Each takes about 100,000 triangles of 3 corners, 32 bytes: some megabytes.
  const RequestContext roomy{{}, {}, false, 64u << 20};
  const RequestContext narrow{{}, {}, false, 1u << 16};
  const auto first = load_request_scene("sweep:7x50000x1", roomy).scene;
  EXPECT_EQ(load_request_scene("sweep:7x50000x1", roomy).scene, first);
  const auto other = load_request_scene("sweep:8x50000x1", narrow).scene;
  EXPECT_NE(load_request_scene("sweep:8x50000x1", narrow).scene, other);
  EXPECT_NE(load_request_scene("sweep:7x50000x1", roomy).scene, first);  // it had to go
}

TEST(ScenesOfRequests, that_many_ask_for_are_loaded_once) {
  const RequestContext roomy{{}, {}, false, 64u << 20};
  std::vector<std::shared_ptr<const Scene>> scenes(12);
  std::vector<std::thread> people;
  for (auto& scene : scenes)
    people.emplace_back([&] { scene = load_request_scene("sweep:9x50000x1", roomy).scene; });
  for (std::thread& person : people) person.join();
  // Two may begin before either is done.
  EXPECT_LE(std::set(scenes.begin(), scenes.end()).size(), 2u);
}

TEST(MemoryBudget, is_shared_by_workers_and_leaves_a_reserve) {
  const std::uint64_t all = usable_memory();
  EXPECT_GE(all, std::uint64_t{1} << 28);
  EXPECT_LT(worker_memory(1), std::max(all, std::uint64_t{1} << 30) + 1);
  EXPECT_LE(worker_memory(2), worker_memory(1));
  if (all > (std::uint64_t{8} << 30)) {
    EXPECT_LT(2 * worker_memory(2), all);
    EXPECT_NEAR(static_cast<double>(worker_memory(1)), 2.0 * static_cast<double>(worker_memory(2)),
                16.0);
  }
}

}  // namespace
}  // namespace penumbra::server
