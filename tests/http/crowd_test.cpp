// Hundreds of clients that send little, and some that send without end, against the real server.
#include <sys/resource.h>

#include "tests/http/raw_request.h"
#include "tests/http/running_server.h"

namespace penumbra::server::http {
namespace {

using Clock = std::chrono::steady_clock;

/// Resident memory of this process, which the server is part of; bytes.
std::size_t resident() {
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0;
  std::size_t pages = 0;
  file >> all >> pages;
  return pages * 4096;
}

class ACrowd : public RunningServer {
 protected:
  void SetUp() override {
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 8192);
    ::setrlimit(RLIMIT_NOFILE, &limit);
    ASSERT_GE(limit.rlim_cur, 4096u) << "both ends of every connection are here";
    RunningServer::SetUp();
  }

  /// Best of some tries, since the machine has other work: seconds for a new connection's request.
  static double time_of_a_request(int port, const std::string& path) {
    double best = 1e9;
    for (int i = 0; i < 5; ++i) {
      const auto start = Clock::now();
      const auto answer =
          send_raw(port, "GET " + path + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
      EXPECT_EQ(answer.status(), 200) << answer.text;
      best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
    }
    return best;
  }

  std::vector<std::unique_ptr<RawConnection>> crowd(int port, int count, const std::string& bytes) {
    std::vector<std::unique_ptr<RawConnection>> list;
    for (int i = 0; i < count; ++i) {
      list.push_back(std::make_unique<RawConnection>(port));
      list.back()->send(bytes);
    }
    return list;
  }
};

TEST_F(ACrowd, OfSlowClientsKeepsTheNextOneWaitingForNoTime) {
  const auto idle = crowd(server->port(), 300, "");
  const auto heads = crowd(server->port(), 300, "GET /api/v1/scenes HTTP/1.1\r\nHost:");
  const auto bodies =
      crowd(server->port(), 300,
            "POST /api/v1/renders HTTP/1.1\r\nHost: x\r\nContent-Length: 99\r\n\r\n{");
  const double time = time_of_a_request(server->port(), "/openapi.json");
  RecordProperty("milliseconds", static_cast<int>(time * 1000));
  EXPECT_LT(time, 0.1);
}

TEST_F(ACrowd, OfSlowClientsLeavesHealthAnswering) {
  const auto slow = crowd(server->ops_port(), 200, "GET /healthz HTTP/1.1\r\nHost:");
  EXPECT_LT(time_of_a_request(server->ops_port(), "/healthz"), 0.1);
}

TEST_F(ACrowd, OfWatchersLeavesThreadsForOthers) {
  const auto id = post("/api/v1/renders", {{"scene", "slow"}, {"technique", "none"}});
  const auto path = json::parse(id->body)["links"]["events"].get<std::string>();
  const auto watchers = crowd(server->port(), 450, "GET " + path + " HTTP/1.1\r\nHost: x\r\n\r\n");
  int watching = 0;
  int refused = 0;
  for (const auto& watcher : watchers) {
    const auto answer = watcher->read(5.0, 200);
    if (answer.status() == 200) ++watching;
    if (answer.status() == 503) ++refused;
  }
  EXPECT_GE(watching, 300);
  EXPECT_GE(refused, 1);
  EXPECT_EQ(watching + refused, 450);
  EXPECT_LT(time_of_a_request(server->port(), "/openapi.json"), 0.3);
  const auto waiting = client->Get("/api/v1/renders/" +
                                   json::parse(id->body)["id"].get<std::string>() + "?wait_s=5");
  EXPECT_EQ(error_of(waiting, 503), "busy");
  EXPECT_FALSE(waiting->get_header_value("Retry-After").empty());
}

TEST_F(ACrowd, OfEndlessRequestsTakesNoMemory) {
  const std::string fields = [] {
    std::string text;
    for (int i = 0; i < 4000; ++i) text += "X-Field: 0123456789\r\n";
    return text;
  }();
  const std::string line(100000, 'x');
  struct Endless {
    std::string what, begin, more;
    bool operations;
  };
  const std::string length = "Host: x\r\nContent-Length: 1000000000\r\n\r\n";
  const std::string chunked = "Host: x\r\nTransfer-Encoding: chunked\r\n\r\n";
  const std::string chunk = "186a0\r\n" + line + "\r\n";
  const std::vector<Endless> all{
      {"fields", "GET / HTTP/1.1\r\nHost: x\r\n", fields, false},
      {"a field", "GET / HTTP/1.1\r\nHost: x\r\nX: ", line, false},
      {"an address", "GET /", line, false},
      {"a body of PRI", "PRI /api/v1/scenes/x HTTP/1.1\r\n" + length, line, false},
      {"chunks of PRI", "PRI /api/v1/scenes/x HTTP/1.1\r\n" + chunked, chunk, false},
      {"a scene without token", "PUT /api/v1/scenes/x HTTP/1.1\r\n" + length, line, false},
      {"chunks of a scene", "PUT /api/v1/scenes/x HTTP/1.1\r\n" + chunked, chunk, false},
      {"a render", "POST /api/v1/renders HTTP/1.1\r\n" + chunked, chunk, false},
      {"a body for health", "POST /healthz HTTP/1.1\r\n" + length, line, true},
      {"fields for health", "GET /healthz HTTP/1.1\r\nHost: x\r\n", fields, true},
  };
  client->Get("/openapi.json");
  for (const auto& endless : all) {
    const auto before = resident();
    RawConnection connection(endless.operations ? server->ops_port() : server->port());
    connection.send(endless.begin);
    std::size_t sent = 0;
    std::size_t most = before;
    while (sent < (100u << 20) && connection.send(endless.more)) {
      sent += endless.more.size();
      most = std::max(most, resident());
    }
    EXPECT_LT(most - before, 16u << 20) << endless.what << ", " << sent << " bytes sent";
  }
  EXPECT_LT(time_of_a_request(server->port(), "/openapi.json"), 1.0);
}

}  // namespace
}  // namespace penumbra::server::http
