#include <thread>

#include "tests/http/running_server.h"

namespace penumbra::server::http {
namespace {

class Operations : public RunningServer {
 protected:
  httplib::Client operations() { return httplib::Client("127.0.0.1", server->ops_port()); }
};

TEST_F(Operations, SayThatTheServerLivesAndIsReady) {
  auto client_of_operations = operations();
  EXPECT_EQ(client_of_operations.Get("/healthz")->status, 200);
  EXPECT_EQ(client_of_operations.Get("/readyz")->status, 200);
}

TEST_F(Operations, CountRequestsByRouteAndState) {
  client->Get("/api/v1/scenes");
  client->Get("/api/v1/scenes");
  client->Get("/api/v1/participants/secret");
  const auto text = operations().Get("/metrics")->body;
  EXPECT_NE(text.find("penumbra_requests_total{route=\"/api/v1/scenes\",status=\"200\"} 2\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("secret"), std::string::npos);
  EXPECT_NE(text.find("# TYPE penumbra_renders_workers gauge\npenumbra_renders_workers 1\n"),
            std::string::npos)
      << text;
}

TEST_F(Operations, LetRunningRequestsFinishWhenTheServerStops) {
  const auto id = body_of(post("/api/v1/renders", {{"scene", "slow"}, {"technique", "none"}}), 202,
                          "Render")["id"]
                      .get<std::string>();
  json waited;
  std::thread waiting([&] {
    httplib::Client other("127.0.0.1", server->port());
    other.set_read_timeout(20);
    waited = body_of(other.Get("/api/v1/renders/" + id + "?wait_s=30"), 200, "Render");
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  client.reset();
  researcher.reset();
  EXPECT_TRUE(server->stop(2.0));
  waiting.join();
  EXPECT_EQ(waited["status"], "cancelled");
}

TEST_F(Operations, IdleConnectionsDoNotHoldAStopUp) {
  EXPECT_EQ(client->Get("/")->status, 303);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(server->stop(10.0));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(4));
}

TEST_F(Operations, OneProcessOwnsADataFolder) {
  ServeOptions theirs;
  theirs.port = 0;
  theirs.ops_port = 0;
  theirs.data = folder.path / "data";
  bool rendered = false;
  try {
    Server second(theirs, [&] {
      rendered = true;
      return std::make_unique<FakeRenders>();
    });
    FAIL() << "two servers own one folder";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "conflict");
    EXPECT_FALSE(rendered);
  }
}

TEST_F(Operations, APortInUseIsNamed) {
  ServeOptions theirs;
  theirs.port = server->port();
  theirs.ops_port = -1;
  theirs.data = folder.path / "other";
  try {
    Server second(theirs, [] { return std::make_unique<FakeRenders>(); });
    FAIL() << "two servers share a port";
  } catch (const Error& error) {
    EXPECT_EQ(error.field, "port");
  }
}

TEST_F(Operations, HundredsOfIdleConnectionsKeepNobodyOut) {
  std::vector<std::unique_ptr<httplib::Client>> idle;
  for (int i = 0; i < 200; ++i) {
    idle.push_back(std::make_unique<httplib::Client>("127.0.0.1", server->port()));
    idle.back()->set_keep_alive(true);
    ASSERT_EQ(idle.back()->Get("/")->status, 303);
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(client->Get("/")->status, 303);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

}  // namespace
}  // namespace penumbra::server::http
