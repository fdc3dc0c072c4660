// Answers survive whatever happens to the process, the disk and the clock.
#include <sqlite3.h>

#include <random>

#include "tests/faults/answering.h"
#include "tests/faults/broken_system.h"
#include "tests/faults/ledger.h"

namespace penumbra::faults {
namespace {

namespace fs = std::filesystem;
using Durability = WithStudy;

TEST_F(Durability, AnswersSurviveTwentyKills) {
  Fault fault(1, "kill -9 amid answers, also between commit and reply");
  ServerProcess server(options());
  constexpr int kills = 20;
  constexpr std::size_t answers = 2100;  // two pages each
  Answering people(server, enter_many(server, answers / 2), 24);
  for (; fault.tries < kills; ++fault.tries) {
    const auto before = people.acknowledged().size();
    // Evenly over all answers, however many come while a server is being killed: people still
    // answer at the last kill.
    const std::size_t due = (fault.tries + 1) * answers / (kills + 1);
    ASSERT_TRUE(eventually([&] {
      const auto now = people.acknowledged().size();
      return now > before && now >= due;
    }));
    server.restart();
    ASSERT_TRUE(server.running()) << server.log();
  }
  people.finish();
  fault.lost = people.acknowledged().lost(server);
  fault.doubled = people.acknowledged().doubled(server);
  fault.did << people.acknowledged().size() << " answers acknowledged, " << people.retried()
            << " calls without a reply sent again under their id";
  EXPECT_EQ(people.acknowledged().size(), answers);
  EXPECT_EQ(people.unexpected(), 0);
  EXPECT_EQ(fault.lost, 0);
  EXPECT_EQ(fault.doubled, 0);
}

TEST_F(Durability, ARetryAfterTheCommitGetsTheStoredReply) {
  Fault fault(1, "the same answer sent again after a kill");
  ServerProcess server(options());
  for (const auto& person : enter_many(server, 5)) {
    ++fault.tries;
    const auto body = person.answer(0, random_uuid()).dump();
    const auto first = server.client().Put(person.page(0), body, "application/json");
    ASSERT_TRUE(first);
    server.restart();
    const auto second = server.client().Put(person.page(0), body, "application/json");
    ASSERT_TRUE(second);
    EXPECT_EQ(second->status, 200);
    EXPECT_EQ(json::parse(first->body), json::parse(second->body));
  }
  fault.doubled = Acknowledged::doubled(server);
  fault.did << "the first reply each time";
}

TEST_F(Durability, PicturesCutOffByAKillAreNeverServed) {
  Fault fault(2, "kill -9 while pictures are written");
  ServerProcess server(options());
  std::mt19937 random(7);
  std::vector<std::string> ids;
  for (; fault.tries < 8; ++fault.tries) {
    const json request = {{"scene", "half-plane"},
                          {"technique", "none"},
                          {"width", 64 + fault.tries},
                          {"height", 64}};
    const auto posted = server.client().Post("/api/v1/renders", request.dump(), "application/json");
    ASSERT_TRUE(posted) << server.log();
    ids.push_back(json::parse(posted->body)["id"]);
    const auto artefacts = data / "artefacts" / ids.back().substr(0, 2) / ids.back();
    // Half of the kills come as soon as the picture's folder is seen, half at some moment.
    if (fault.tries % 2 == 0)
      eventually([&] { return fs::exists(artefacts); }, 10);
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(random() % 60));
    server.restart();
  }
  int whole = 0;
  for (const auto& id : ids) {
    const auto image = server.client().Get("/api/v1/renders/" + id + "/image.png");
    ASSERT_TRUE(image);
    if (image->status == 200) {
      ++whole;
      EXPECT_TRUE(image->body.starts_with("\x89PNG") &&
                  image->body.ends_with("IEND\xae\x42\x60\x82"));
    } else {
      EXPECT_EQ(image->status, 404) << image->body;
    }
  }
  int leftovers = 0;
  for (const char* place : {"artefacts/new", "incoming"})
    if (fs::exists(data / place))
      for ([[maybe_unused]] const auto& entry : fs::directory_iterator(data / place)) ++leftovers;
  EXPECT_EQ(leftovers, 0);
  fault.did << whole << " pictures whole, the others unknown, " << leftovers << " leftovers";
}

TEST_F(Durability, AnExportCutOffByAKillLeavesNothing) {
  Fault fault(2, "kill -9 while an export is written");
  ServerProcess server(options());
  Answering people(server, enter_many(server, 60), 8);
  people.finish();
  const auto files = [&] {
    std::error_code none;
    return std::distance(fs::directory_iterator(data / "tmp", none), fs::directory_iterator());
  };
  while (fault.tries < 3) {
    std::thread researcher([&] { server.researcher().Get(study_at + "/export.zip"); });
    const bool seen = eventually([&] { return files() > 0; }, 5, 0);
    server.kill();
    researcher.join();
    if (seen && files() > 0) ++fault.tries;
    server.start();
    ASSERT_TRUE(server.running()) << server.log();
    EXPECT_EQ(files(), 0);
  }
  fault.lost = people.acknowledged().lost(server);
  fault.did << "what it had written was gone after the start";
}

TEST_F(Durability, PicturesAreDeliveredThoughTheCacheIsFull) {
  Fault fault(3, "no room for the cache of pictures");
  const BrokenSystem system(folder.path / "system", data);
  auto all = options();
  all.environment = system.environment("artefacts");
  ServerProcess server(all);
  system.fill_disk();
  for (; fault.tries < 4; ++fault.tries) {
    const auto image = server.client().Get("/api/v1/image?scene=half-plane&technique=none&width=3" +
                                           std::to_string(fault.tries) + "&height=32");
    ASSERT_TRUE(image);
    EXPECT_EQ(image->status, 200) << image->body;
  }
  const double failures = server.metric("penumbra_renders_cache_write_failures");
  EXPECT_GE(failures, fault.tries);
  fault.did << fault.tries << " pictures delivered, " << failures << " failures counted";
}

/// Answers while something is wrong are refused and those after it are taken.
void expect_refused_then_taken(Fault& fault, ServerProcess& server,
                               const std::function<void()>& begin,
                               const std::function<void()>& end) {
  const auto people = enter_many(server, 6);
  Acknowledged acknowledged;
  const auto put = [&](const Person& person, std::size_t page, const std::string& id) {
    auto result =
        server.client().Put(person.page(page), person.answer(page, id).dump(), "application/json");
    EXPECT_TRUE(result) << server.log();
    if (result && result->status == 200) acknowledged.add(person, page, id, result->body);
    return result;
  };
  for (const auto& person : people) EXPECT_EQ(put(person, 0, random_uuid())->status, 200);
  begin();
  std::vector<std::string> ids;
  for (const auto& person : people) {
    ++fault.tries;
    ids.push_back(random_uuid());
    const auto refused = put(person, 1, ids.back());
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->status, 503) << refused->body;
    EXPECT_FALSE(refused->get_header_value("Retry-After").empty());
  }
  end();
  const double recovered = seconds_of([&] {
    EXPECT_TRUE(eventually([&] {
      const auto result = put(people[0], 1, ids[0]);
      return result && result->status == 200;
    }));
  });
  for (std::size_t i = 1; i < people.size(); ++i) EXPECT_EQ(put(people[i], 1, ids[i])->status, 200);
  fault.lost = acknowledged.lost(server);
  fault.doubled = acknowledged.doubled(server);
  fault.did << "each 503 with Retry-After, none acknowledged; taken again "
            << static_cast<int>(recovered * 1000)
            << " ms after the cause was gone, without a start";
}

TEST_F(Durability, AFullDiskIsRefusedAndRecovers) {
  Fault fault(4, "no room for the database");
  const BrokenSystem system(folder.path / "system", data);
  auto all = options();
  all.environment = system.environment();
  ServerProcess server(all);
  expect_refused_then_taken(
      fault, server, [&] { system.fill_disk(); }, [&] { system.free_disk(); });
}

TEST_F(Durability, ALimitOfFileSizesIsRefusedAndRecovers) {
  Fault fault(5, "a limit of file sizes (SIGXFSZ)");
  ServerProcess server(options());
  expect_refused_then_taken(
      fault, server, [&] { server.limit(RLIMIT_FSIZE, 4096); },
      [&] { server.limit(RLIMIT_FSIZE, RLIM_INFINITY); });
}

TEST_F(Durability, ALockedDatabaseIsRefusedAndRecovers) {
  Fault fault(6, "another process locks the database");
  ServerProcess server(options());
  auto client = server.client();
  const auto person = enter(client);
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open((data / "penumbra.sqlite").c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  const auto body = person.answer(0, random_uuid()).dump();
  const Stopwatch watch;
  const auto refused = client.Put(person.page(0), body, "application/json");
  const double waited = watch.seconds();
  ++fault.tries;
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503) << refused->body;
  EXPECT_FALSE(refused->get_header_value("Retry-After").empty());
  EXPECT_LT(waited, 8.0);
  // Reading goes on meanwhile.
  EXPECT_EQ(client.Get(person.at())->status, 200);
  sqlite3_exec(other, "ROLLBACK", nullptr, nullptr, nullptr);
  sqlite3_close(other);
  EXPECT_EQ(client.Put(person.page(0), body, "application/json")->status, 200);
  fault.doubled = Acknowledged::doubled(server);
  fault.did << "503 after " << static_cast<int>(waited * 1000) << " ms, taken afterwards";
}

TEST_F(Durability, AnswersSurvivePowerCuts) {
  Fault fault(8, "power cut: only what was synced is left");
  const BrokenSystem system(folder.path / "system", data);
  auto all = options();
  all.environment = system.with_shadow();
  system.take_as_synced();
  ServerProcess server(all);
  std::size_t total = 0;
  for (; fault.tries < 3; ++fault.tries) {
    Answering people(server, enter_many(server, 60), 8);
    eventually([&] { return people.acknowledged().size() >= 100; });
    server.kill();
    people.stop();
    system.cut_power();
    server.start();
    ASSERT_TRUE(server.running()) << server.log();
    fault.lost += people.acknowledged().lost(server);
    total += people.acknowledged().size();
  }
  EXPECT_GE(total, 300u);
  EXPECT_EQ(fault.lost, 0);
  fault.doubled = Acknowledged::doubled(server);
  fault.did << total << " answers acknowledged";
}

TEST_F(Durability, TheLogOfTheDatabaseStaysBoundedUnderAReader) {
  Fault fault(9, "a long reader beside a stream of answers");
  ServerProcess server(options());
  Answering people(server, enter_many(server, 300), 8);
  sqlite3* reader = nullptr;
  ASSERT_EQ(sqlite3_open((data / "penumbra.sqlite").c_str(), &reader), SQLITE_OK);
  sqlite3_exec(reader, "BEGIN; SELECT COUNT(*) FROM answers", nullptr, nullptr, nullptr);
  ++fault.tries;
  people.finish();
  const auto size = [&] { return fs::file_size(data / "penumbra.sqlite-wal"); };
  const auto while_read = size();
  sqlite3_exec(reader, "COMMIT", nullptr, nullptr, nullptr);
  sqlite3_close(reader);
  // The next answers find the reader gone.
  Answering more(server, enter_many(server, 100), 8);
  more.finish();
  EXPECT_LT(size(), 16u << 20);
  fault.lost = people.acknowledged().lost(server) + more.acknowledged().lost(server);
  fault.did << (while_read >> 10) << " KiB while it read, " << (size() >> 10) << " KiB afterwards, "
            << people.acknowledged().size() << " answers meanwhile";
}

TEST_F(Durability, AlteredPicturesInTheCacheAreDrawnAgain) {
  Fault fault(11, "altered and cut entries of the cache");
  ServerProcess server(options());
  const std::string query =
      "/api/v1/image?scene=half-plane&technique=shadow-map&width=32&height=32";
  const auto original = server.client().Get(query);
  ASSERT_TRUE(original);
  ASSERT_EQ(original->status, 200) << original->body;
  const auto image_of = [&] {
    for (const auto& entry : fs::recursive_directory_iterator(data / "artefacts"))
      if (entry.path().filename() == "image.png" && fs::file_size(entry) == original->body.size()) {
        std::ifstream file(entry.path(), std::ios::binary);
        std::ostringstream bytes;
        bytes << file.rdbuf();
        if (bytes.str() == original->body) return entry.path();
      }
    return fs::path();
  };
  for (const std::string kind : {"flipped", "cut", "empty", "removed"}) {
    ++fault.tries;
    const auto file = image_of();
    ASSERT_FALSE(file.empty()) << kind;
    server.kill();
    if (kind == "flipped") {
      std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
      bytes.seekp(60);
      bytes.put(static_cast<char>(original->body[60] ^ 1));
    } else if (kind == "cut") {
      fs::resize_file(file, original->body.size() / 2);
    } else if (kind == "empty") {
      fs::resize_file(file, 0);
    } else {
      fs::remove(file);
    }
    server.start();
    const auto again = server.client().Get(query);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->status, 200) << kind << again->body;
    EXPECT_EQ(again->body, original->body) << kind;
  }
  fault.did << "the original bytes each time";
}

TEST_F(Durability, AClockThatJumpsMovesNoDeadline) {
  Fault fault(12, "the clock steps by an hour, a day");
  const BrokenSystem system(folder.path / "system", data);
  auto all = options();
  all.environment = system.environment();
  ServerProcess server(all);
  const auto posted =
      server.client().Post("/api/v1/renders", slow_render(1000).dump(), "application/json");
  ASSERT_TRUE(posted);
  const std::string at = "/api/v1/renders/" + json::parse(posted->body)["id"].get<std::string>();
  for (const long step : {3600L, -3600L, -86400L}) {
    ++fault.tries;
    std::thread jump([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      system.move_clock(step);
    });
    const double waited =
        seconds_of([&] { EXPECT_EQ(server.client().Get(at + "?wait_s=1")->status, 200); });
    jump.join();
    EXPECT_GT(waited, 0.9) << step;
    EXPECT_LT(waited, 3.0) << step;
    auto client = server.client();
    const auto person = enter(client);
    ASSERT_FALSE(person.token.empty()) << step;
    const auto body = person.answer(0, random_uuid()).dump();
    EXPECT_EQ(client.Put(person.page(0), body, "application/json")->status, 200) << step;
  }
  fault.did << "a wait of 1 s lasted 1 s, answers were taken";
}

}  // namespace
}  // namespace penumbra::faults
