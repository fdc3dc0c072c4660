#include "tests/faults/traffic.h"

#include <algorithm>
#include <cstdio>
#include <random>

#include "tests/faults/people.h"
#include "tests/http/raw_request.h"

namespace penumbra::faults {
namespace {

namespace fs = std::filesystem;

/// What is looked at now and then.
struct Sample {
  double minutes = 0;
  std::size_t resident = 0;
  std::size_t descriptors = 0;
  std::size_t log = 0;  ///< bytes of the database's write-ahead log
};

class Traffic {
 public:
  explicit Traffic(const ServerProcess& server_) : server(server_) {}

  void start() {
    run([this](auto& random) { take_part(random); }, 4, 100);
    run([this](auto& random) { draw(random); }, 2, 50);
    run([this](auto& random) { look(random); }, 2, 50);
    run([this](auto&) { research(); }, 1, 2000);
    run([this](auto& random) { upload(random); }, 1, 1000);
    run([this](auto& random) { send_nonsense(random); }, 1, 500);
  }
  void stop() {
    stopping = true;
    for (auto& thread : threads) thread.join();
  }

  std::atomic<std::size_t> calls = 0;
  std::atomic<std::size_t> failures = 0;  ///< no reply, or 5xx other than 503

 private:
  using Random = std::mt19937;

  template <class Action>
  void run(Action action, unsigned count, int pause_ms) {
    for (unsigned i = 0; i < count; ++i)
      threads.emplace_back([this, action, pause_ms, seed = 100 * threads.size() + i]() {
        Random random(static_cast<unsigned>(seed));
        while (!stopping) {
          action(random);
          std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms));
        }
      });
  }

  void count(const httplib::Result& result) {
    ++calls;
    if (result && (result->status < 500 || result->status == 503)) return;
    ++failures;
    std::printf("failed: %s\n", result ? result->body.c_str() : "no reply");
  }

  /// Nine of ten withdraw in the end, so that what is stored grows slowly.
  void take_part(Random& random) {
    auto client = server.client();
    const auto person = enter(client);
    ++calls;
    if (person.token.empty()) return;
    for (std::size_t page = 0; page < person.pages.size(); ++page) {
      for (const auto& image : person.pages[page]["images"])
        count(client.Get(image["url"].get<std::string>()));
      count(client.Put(person.page(page), person.answer(page, random_uuid()).dump(),
                       "application/json"));
    }
    count(client.Post(person.at() + "/complete", "{}", "application/json"));
    if (random() % 10 != 0) count(client.Delete("/api/v1/withdrawals/" + person.withdrawal_code));
  }

  void draw(Random& random) {
    const char* techniques[] = {"none", "shadow-map", "pcf", "vsm", "shadow-volumes", "reference"};
    const auto size = std::to_string(16 + random() % 48);
    count(server.client().Get("/api/v1/image?scene=half-plane&light_samples=4&technique=" +
                              std::string(techniques[random() % 6]) + "&width=" + size +
                              "&height=" + size));
  }

  void look(Random& random) {
    const char* paths[] = {"/api/v1/scenes",   "/api/v1/techniques",
                           "/openapi.json",    "/s/small",
                           "/s/small/welcome", "/api/v1/plan?scene=boxes&technique=pcf"};
    count(server.client().Get(paths[random() % 6]));
  }

  void research() {
    auto client = server.researcher();
    count(client.Get(study_at));
    count(client.Get(study_at + "/responses.csv"));
    count(client.Get(study_at + "/results.json"));
    count(client.Get(study_at + "/export.zip"));
  }

  void upload(Random& random) {
    const std::string document =
        R"({"penumbra_scene":1,"meshes":[{"positions":[0,0,0,1,0,0,0,1,0],"indices":[0,1,2]}],)"
        R"("instances":[{"mesh":0}]})";
    auto client = server.researcher();
    const auto at = "/api/v1/scenes/upload-" + std::to_string(random() % 5);
    count(client.Put(at, random() % 2 == 0 ? document : document.substr(0, random() % 100),
                     "application/json"));
    if (random() % 2 == 0) count(client.Delete(at));
  }

  void send_nonsense(Random& random) {
    std::string bytes(random() % 2000, '\0');
    for (auto& byte : bytes) byte = static_cast<char>(random());
    server::http::send_raw(server.port(), bytes, 1);
    server::http::send_raw(server.port(), "GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\n",
                           1);
    calls += 2;
  }

  const ServerProcess& server;
  std::atomic<bool> stopping = false;
  std::vector<std::thread> threads;
};

Sample sample_of(const ServerProcess& server, double minutes) {
  std::error_code none;
  const auto log = fs::file_size(server.data() / "penumbra.sqlite-wal", none);
  return {minutes, server.resident(), server.descriptors(), none ? 0 : log};
}

/// Median of one number over a part of the samples.
std::size_t median(const std::vector<Sample>& samples, std::size_t begin, std::size_t end,
                   std::size_t Sample::*number) {
  std::vector<std::size_t> values;
  for (std::size_t i = begin; i < end; ++i) values.push_back(samples[i].*number);
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

}  // namespace

int run_traffic(double minutes) {
  const server::TemporaryFolder folder;
  ServerOptions options;
  options.data = folder.path / "data";
  copy_published(options.data);
  const ServerProcess server(options);
  Traffic traffic(server);
  traffic.start();
  std::vector<Sample> samples;
  const Stopwatch watch;
  constexpr double between_s = 2.0;
  while (watch.seconds() < 60 * minutes && server.running()) {
    std::this_thread::sleep_for(std::chrono::duration<double>(between_s));
    samples.push_back(sample_of(server, watch.seconds() / 60));
    if (samples.size() % 15 == 0) {
      const auto& now = samples.back();
      std::printf("%6.1f min: %4zu MiB, %3zu descriptors, log %5zu KiB, %zu calls, %zu failed\n",
                  now.minutes, now.resident >> 20, now.descriptors, now.log >> 10,
                  traffic.calls.load(), traffic.failures.load());
      std::fflush(stdout);
    }
  }
  traffic.stop();
  if (!server.running() || samples.size() < 8) {
    std::printf("the server ended, or there was too little time\n");
    return 1;
  }
  // The first quarter warms up: the second is compared with the last.
  const auto quarter = samples.size() / 4;
  const auto early = [&](std::size_t Sample::*number) {
    return median(samples, quarter, 2 * quarter, number);
  };
  const auto late = [&](std::size_t Sample::*number) {
    return median(samples, 3 * quarter, samples.size(), number);
  };
  const bool memory = late(&Sample::resident) < early(&Sample::resident) * 115 / 100 + (16u << 20);
  const bool descriptors = late(&Sample::descriptors) <= early(&Sample::descriptors) + 16;
  const bool log = late(&Sample::log) < 16u << 20;
  std::printf(
      "%zu calls, %zu failed; memory %zu then %zu MiB, descriptors %zu then %zu, log %zu "
      "then %zu KiB: %s\n",
      traffic.calls.load(), traffic.failures.load(), early(&Sample::resident) >> 20,
      late(&Sample::resident) >> 20, early(&Sample::descriptors), late(&Sample::descriptors),
      early(&Sample::log) >> 10, late(&Sample::log) >> 10,
      memory && descriptors && log ? "nothing grew" : "GREW");
  return memory && descriptors && log && traffic.failures == 0 ? 0 : 1;
}

}  // namespace penumbra::faults
