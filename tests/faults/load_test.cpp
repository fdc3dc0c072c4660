// Many at once, and a server that runs out of something.
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <set>

#include "tests/faults/answering.h"
#include "tests/faults/ledger.h"
#include "tests/faults/traffic.h"

namespace penumbra::faults {
namespace {

using Load = WithStudy;

json quick_render(int width) {
  return {{"scene", "half-plane"}, {"technique", "none"}, {"width", width}, {"height", 16}};
}

TEST_F(Load, AFloodOfRequestsFillsTheQueueAndNoMore) {
  Fault fault(23, "400 distinct requests, a queue of 20");
  ServerProcess server(options({"--queue-limit", "20"}));
  ASSERT_GT(server.worker(), 0);
  std::mutex mutex;
  std::vector<std::string> taken;
  std::atomic<int> refused = 0;
  std::atomic<int> other = 0;
  std::atomic<int> next = 0;
  std::vector<std::thread> people;
  for (int thread = 0; thread < 20; ++thread)
    people.emplace_back([&] {
      auto client = server.client();
      for (int i = next++; i < 400; i = next++) {
        auto body = quick_render(16 + i);
        body["height"] = 200;
        body["supersampling"] = 16;
        const auto result = client.Post("/api/v1/renders", body.dump(), "application/json");
        if (result && (result->status == 202 || result->status == 200)) {
          const std::lock_guard lock(mutex);
          taken.push_back(json::parse(result->body)["id"]);
        } else if (result && result->status == 503 && result->has_header("Retry-After")) {
          ++refused;
        } else {
          ++other;
        }
      }
    });
  for (auto& person : people) person.join();
  fault.tries = 400;
  EXPECT_EQ(other, 0);
  EXPECT_GT(refused, 0);
  for (const auto& id : taken) {
    const auto done = server.client().Get("/api/v1/renders/" + id + "?wait_s=50");
    ASSERT_TRUE(done);
    if (json::parse(done->body)["status"] != "done") ++fault.lost;
  }
  EXPECT_EQ(fault.lost, 0);
  fault.did << taken.size() << " taken and all drawn, " << refused << " times 503 with Retry-After";
}

/// The time below which this share of the sorted ones is.
double quantile(const std::vector<double>& sorted, double share) {
  return sorted.at(static_cast<std::size_t>(share * (static_cast<double>(sorted.size()) - 1.0)));
}

std::ptrdiff_t lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return std::count(std::istreambuf_iterator<char>(in), {}, '\n');
}

/// Median seconds of a file's append and sync, which a stored answer needs twice.
double seconds_of_sync(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  const std::string bytes(4096, 'x');
  std::vector<double> times;
  for (int i = 0; i < 31; ++i)
    times.push_back(seconds_of([&] {
      EXPECT_EQ(::write(descriptor, bytes.data(), bytes.size()), 4096);
      EXPECT_EQ(::fdatasync(descriptor), 0);
    }));
  ::close(descriptor);
  std::sort(times.begin(), times.end());
  return quantile(times, 0.5);
}

TEST_F(Load, TwoHundredPeopleAnswerAtOnce) {
  Fault fault(0, "200 people answer at once");
  ServerProcess server(options());
  const double sync = seconds_of_sync(folder.path / "sync");
  Answering one(server, enter_many(server, 50), 1);
  one.finish();
  const double alone = quantile(one.seconds(), 0.5);
  const auto crowd = enter_many(server, 600);
  const auto commits_before = lines_of(data / "answers.journal");
  Answering people(server, crowd, 200);
  people.finish();
  const auto commits = lines_of(data / "answers.journal") - commits_before;
  const auto times = people.seconds();
  ASSERT_EQ(times.size(), 1200u);
  fault.tries = static_cast<int>(times.size());
  fault.lost = people.acknowledged().lost(server);
  fault.doubled = Acknowledged::doubled(server);
  EXPECT_EQ(people.retried(), 0);
  EXPECT_EQ(fault.lost, 0);
  // Together they share commits, of which the journal has a line each. How long that takes is told
  // and not judged: 200 threads of clients share the machine.
  EXPECT_LT(commits, 1200 / 4);
  fault.did << std::fixed << std::setprecision(1) << "median " << 1000 * quantile(times, 0.5)
            << " ms, 99 of 100 under " << 1000 * quantile(times, 0.99) << " ms, " << commits
            << " commits; a lone answer " << 1000 * alone << " ms, a sync of the disk "
            << 1000 * sync << " ms; the client's threads on the same machine";
}

TEST_F(Load, ExhaustedDescriptorsAreSurvived) {
  Fault fault(25, "descriptors exhausted by idle connections");
  ServerProcess server(options());
  ASSERT_GT(server.worker(), 0);
  auto client = server.client();
  const auto person = enter(client);
  const auto limit = server.descriptors() + 24;
  server.limit(RLIMIT_NOFILE, limit);
  {
    std::vector<std::unique_ptr<httplib::Client>> idle;
    for (; fault.tries < 100; ++fault.tries) {
      idle.push_back(std::make_unique<httplib::Client>("127.0.0.1", server.port()));
      idle.back()->set_keep_alive(true);
      idle.back()->set_read_timeout(0, 20000);
      idle.back()->Get("/api/v1/scenes");
    }
    EXPECT_TRUE(server.running());
    EXPECT_LE(server.descriptors(), limit);
  }
  EXPECT_TRUE(eventually([&] {
    const auto put =
        client.Put(person.page(0), person.answer(0, random_uuid()).dump(), "application/json");
    return put && put->status == 200;
  }));
  EXPECT_EQ(server.operations().Get("/healthz")->status, 200);
  fault.did << "answers were taken again once the connections were closed";
}

TEST_F(Load, ASignalUnderLoadDrains) {
  Fault fault(26, "SIGTERM amid answers and a render");
  for (; fault.tries < 3; ++fault.tries) {
    ServerProcess server(options({"--drain-deadline", "3"}));
    ASSERT_GT(server.worker(), 0);
    server.client().Post("/api/v1/renders", slow_render(1000 + fault.tries).dump(),
                         "application/json");
    Answering people(server, enter_many(server, 100), 16);
    eventually([&] { return people.acknowledged().size() >= 50; });
    const Stopwatch watch;
    EXPECT_EQ(server.terminate(30), 0) << server.log();
    EXPECT_LT(watch.seconds(), 15.0);
    people.stop();
    server.start();
    ASSERT_TRUE(server.running()) << server.log();
    fault.lost += people.acknowledged().lost(server);
    fault.did << people.acknowledged().size() << " acknowledged, exit 0 after "
              << static_cast<int>(watch.seconds() * 1000) << " ms; ";
  }
  EXPECT_EQ(fault.lost, 0);
}

TEST(Traffic, LongMixedTrafficGrowsNothing) {
  Fault fault(0, "five minutes of mixed traffic");
  ++fault.tries;
  EXPECT_EQ(run_traffic(5.0), 0);
  fault.did << "memory, descriptors and the database's log did not grow";
}

std::string status_of(const ServerProcess& server, const std::string& at) {
  const auto result = server.client().Get(at);
  return result && result->status == 200 ? json::parse(result->body).value("status", "") : "";
}

TEST_F(Load, ARenderStopsWhenItsOnlyClientIsGoneAndNotForABystander) {
  Fault fault(21, "clients that hang up or cancel");
  ServerProcess server(options());
  const auto body = slow_render(1000).dump();
  // Its owner waits elsewhere; a bystander looks on and hangs up, and a stranger cancels.
  const auto posted = server.client().Post("/api/v1/renders", body, "application/json");
  ASSERT_TRUE(posted);
  const std::string at = "/api/v1/renders/" + json::parse(posted->body)["id"].get<std::string>();
  ++fault.tries;
  auto bystander = server.client();
  bystander.set_read_timeout(1);
  EXPECT_FALSE(bystander.Get(at + "?wait_s=30"));
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  const auto status = status_of(server, at);
  EXPECT_TRUE(status == "queued" || status == "running") << status;
  // One who asked for a picture and hung up: the worker is free again.
  ++fault.tries;
  auto impatient = server.client();
  impatient.set_read_timeout(1);
  EXPECT_FALSE(
      impatient.Get("/api/v1/image?scene=boxes&technique=reference&width=1001&height=1000&"
                    "supersampling=16&light_samples=65536"));
  server.researcher().Delete(at);
  const auto quick = server.client().Get("/api/v1/image?scene=half-plane&technique=none&width=16");
  ASSERT_TRUE(quick);
  EXPECT_EQ(quick->status, 200) << quick->body;
  fault.did << "kept for its owner, stopped where nobody waited";
}

TEST_F(Load, TwoHundredIdenticalRequestsAreOneRender) {
  Fault fault(22, "200 identical requests at once");
  ServerProcess server(options());
  ASSERT_GT(server.worker(), 0);
  std::mutex mutex;
  std::set<std::string> bodies;
  std::vector<std::thread> people;
  for (int i = 0; i < 200; ++i)
    people.emplace_back([&] {
      const auto image = server.client().Get(
          "/api/v1/image?scene=boxes&technique=pcf&width=100&height=100&supersampling=4");
      const std::lock_guard lock(mutex);
      ++fault.tries;
      bodies.insert(image && image->status == 200 ? image->body : "failed");
      if (!image) {
        ADD_FAILURE() << httplib::to_string(image.error());
      } else if (image->status != 200) {
        ADD_FAILURE() << image->status << image->body;
      }
    });
  for (auto& person : people) person.join();
  EXPECT_EQ(bodies.size(), 1u);
  EXPECT_FALSE(bodies.contains("failed"));
  EXPECT_EQ(server.metric("penumbra_renders_rendered"), 1);
  fault.did << "one render for all, equal bytes";
}

/// Bytes on disk below a folder, whole blocks counted.
std::size_t disk_use(const std::filesystem::path& folder) {
  std::size_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    struct stat state {};
    if (::lstat(entry.path().c_str(), &state) == 0)
      bytes += static_cast<std::size_t>(state.st_blocks) * 512;
  }
  return bytes;
}

TEST_F(Load, TheCacheKeepsItsBound) {
  Fault fault(24, "120 pictures, a cache of 2 MiB");
  constexpr std::size_t bound = 2 << 20;
  ServerProcess server(options({"--cache-bytes", std::to_string(bound)}));
  const auto at = [](int width) {
    return "/api/v1/image?scene=half-plane&technique=none&height=16&width=" + std::to_string(width);
  };
  std::string first;
  for (; fault.tries < 120; ++fault.tries) {
    const auto image = server.client().Get(at(16 + fault.tries));
    ASSERT_TRUE(image);
    ASSERT_EQ(image->status, 200) << image->body;
    if (first.empty()) first = image->body;
  }
  const auto used = disk_use(data / "artefacts");
  EXPECT_LT(used, bound + bound / 4);
  // The oldest is gone and drawn again, bytes equal.
  const auto again = server.client().Get(at(16));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->body, first);
  fault.did << used / 1024 << " KiB on disk in the end";
}

}  // namespace
}  // namespace penumbra::faults
