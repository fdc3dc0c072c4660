// What survives a kill: results that were told, whole lines only, and children that die.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>

#include <fstream>

#include "experiments/engine/results.h"
#include "experiments/stability/child.h"
#include "renderer/error.h"

namespace penumbra::experiments {
namespace {

namespace fs = std::filesystem;

struct Folder {
  Folder() {
    std::string name = (fs::temp_directory_path() / "penumbra-stability-XXXXXX").string();
    path = ::mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path); }
  fs::path path;
};

TEST(Results, name_a_folder_that_is_not_there) {
  try {
    Results("/nowhere/at/all/results.jsonl");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "unwritable");
    EXPECT_EQ(error.field, "out");
  }
}

std::vector<nlohmann::json> heard_of(Child& child) {
  std::vector<nlohmann::json> lines;
  while (child.read([&](const nlohmann::json& line) { lines.push_back(line); })) continue;
  return lines;
}

TEST(Children, tell_what_they_found_and_end) {
  Child child([](const Child::Tell& tell) {
    for (int i = 0; i < 1000; ++i) tell({{"i", i}});
  });
  const auto lines = heard_of(child);
  ASSERT_EQ(lines.size(), 1000u);
  EXPECT_EQ(lines.back().at("i"), 999);
  EXPECT_EQ(child.death(), "");
}

TEST(Children, that_crash_leave_what_they_told_before_and_how_they_died) {
  Child child([](const Child::Tell& tell) {
    tell({{"step", 1}});
    ::raise(SIGKILL);
  });
  EXPECT_EQ(heard_of(child).size(), 1u);
  EXPECT_THAT(child.death(), testing::HasSubstr("signal 9"));
}

TEST(Children, that_throw_end_with_a_state) {
  Child child([](const Child::Tell&) { throw std::runtime_error("of no use"); });
  EXPECT_TRUE(heard_of(child).empty());
  EXPECT_EQ(child.death(), "exit status 1");
}

TEST(Children, that_never_end_can_be_ended) {
  Child child([](const Child::Tell& tell) {
    tell({{"begin", 1}});
    for (;;) ::poll(nullptr, 0, 1000);
  });
  bool began = false;
  while (!began) ASSERT_TRUE(child.read([&](const nlohmann::json&) { began = true; }));
  child.kill();
  EXPECT_TRUE(heard_of(child).empty());
  EXPECT_THAT(child.death(), testing::HasSubstr("signal 9"));
}

}  // namespace
}  // namespace penumbra::experiments
