// Bytes after a refused head are never read as a request, however they are sent.
#include <array>
#include <cstdio>

#include "tests/http/behind_nginx.h"
#include "tests/http/raw_request.h"

namespace penumbra::server::http {
namespace {

const std::string hidden = "GET /api/v1/scenes HTTP/1.1\r\nHost: x\r\n\r\n";

/// Calls of the hidden request's route so far.
bool was_called(const Server& server) {
  httplib::Client operations("127.0.0.1", server.ops_port());
  return operations.Get("/metrics")->body.find("route=\"/api/v1/scenes\"") != std::string::npos;
}

std::string head_of(const std::string& method, const std::string& fields) {
  return method + " /api/v1/renders HTTP/1.1\r\nHost: x\r\n" + fields + "\r\n";
}

const std::string long_field = "X-Long: " + std::string(9000, 'x') + "\r\n";

class HiddenRequests : public RunningServer {
 protected:
  /// Sends a head, reads its answer, then sends what a careless server takes for a request.
  void expect_the_end_after(const std::string& head, const std::string& what) {
    RawConnection connection(server->port());
    ASSERT_TRUE(connection.send(head)) << what;
    auto answer = connection.read(5.0);
    EXPECT_GE(answer.status(), 400) << what << ": " << answer.text;
    EXPECT_TRUE(answer.closed) << what;
    EXPECT_NE(answer.text.find("\r\nConnection: close\r\n"), std::string::npos) << answer.text;
    EXPECT_EQ(answer.text.find("Keep-Alive"), std::string::npos) << answer.text;
    connection.send(hidden);
    EXPECT_EQ(connection.read(0.5).text, "") << what;
    // The same bytes sent at once.
    const auto both = send_raw(server->port(), head + hidden);
    EXPECT_TRUE(both.closed) << what;
    EXPECT_EQ(both.text.find("HTTP/1.1", 5), std::string::npos) << what << ": " << both.text;
  }
};

TEST_F(HiddenRequests, AreNotReadAfterARefusedHead) {
  const auto length = "Content-Length: " + std::to_string(hidden.size()) + "\r\n";
  for (const std::string method : {"OPTIONS", "TRACE", "CONNECT", "PRI", "HEAD", "GET", "FOO"})
    for (const auto& fields : {length, std::string("Transfer-Encoding: chunked\r\n")})
      expect_the_end_after(head_of(method, fields), method + " " + fields);
  for (const std::string method : {"GET", "HEAD", "POST", "PUT", "DELETE"})
    expect_the_end_after(head_of(method, long_field + length), method + " with a long line");
  for (const std::string fields :
       {"Content-Length: 5\r\nContent-Length: 6\r\n", "Content-Length : 5\r\n",
        "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", "A: b\n", " folded\r\n"})
    expect_the_end_after(head_of("POST", fields), fields);
  expect_the_end_after("POST /api/v1/renders HTTP/1.1\r\n" + length + "\r\n", "no Host");
  EXPECT_FALSE(was_called(*server));
}

TEST_F(HiddenRequests, AreNotReadAfterABodyThatWasRefusedUnread) {
  const auto large = "Content-Length: " + std::to_string(1 << 20) + "\r\n";
  expect_the_end_after("PUT /api/v1/scenes/mine HTTP/1.1\r\nHost: x\r\n" + large + "\r\n", "token");
  expect_the_end_after(head_of("POST", large), "too large");
  expect_the_end_after("PUT /nothing HTTP/1.1\r\nHost: x\r\n" + large + "\r\n", "no route");
  expect_the_end_after(head_of("POST", "Range: bytes=x\r\n" + large), "a range");
  expect_the_end_after(head_of("POST", "Transfer-Encoding: chunked\r\n") + "zz\r\n", "chunks");
  EXPECT_FALSE(was_called(*server));
}

TEST_F(HiddenRequests, OfWellBehavedClientsAreAnsweredInOrder) {
  const auto body = std::string("{}");
  RawConnection connection(server->port());
  connection.send(head_of("POST", "Content-Length: 2\r\n") + body + hidden);
  const auto answer = connection.read(0.5);
  EXPECT_EQ(answer.status(), 400);
  EXPECT_NE(answer.text.find("HTTP/1.1 200", 5), std::string::npos) << answer.text;
  EXPECT_FALSE(answer.closed);
}

TEST_F(HiddenRequests, ClientsThatAskWhetherToSendAreToldSo) {
  RawConnection connection(server->port());
  connection.send(head_of("POST", "Expect: 100-continue\r\nContent-Length: 2\r\n"));
  const std::string go_on = "HTTP/1.1 100 Continue\r\n\r\n";
  EXPECT_EQ(connection.read(2.0, go_on.size()).text, go_on);
  connection.send("{}");
  EXPECT_EQ(connection.read(0.5).status(), 400);
  const auto refused = send_raw(server->port(),
                                "PUT /api/v1/scenes/mine HTTP/1.1\r\nHost: x\r\nExpect: "
                                "100-continue\r\nContent-Length: 1000000\r\n\r\n");
  EXPECT_EQ(refused.status(), 401) << refused.text;
  EXPECT_TRUE(refused.closed);
}

/// nginx set up to share its connections to the server, which deploy/nginx.conf does not: the
/// server's own reading has to suffice.
class HiddenRequestsThroughNginx : public BehindNginx, public testing::WithParamInterface<bool> {
 protected:
  void edit(std::string& site) const override {
    if (!GetParam()) return;
    const auto put = [&](const std::string& what, const std::string& by) {
      const auto found = site.find(what);
      ASSERT_NE(found, std::string::npos) << what;
      site.replace(found, what.size(), by);
    };
    put("proxy_set_header Connection close;", "proxy_set_header Connection \"\";");
    put(std::to_string(server->port()) + ";", std::to_string(server->port()) + "; keepalive 4;");
  }

  /// State and protocol that curl reports.
  std::string curl(const std::string& arguments) const {
    const auto command = "curl -sk -o /dev/null -m 10 -w '%{http_code} %{http_version}' " +
                         arguments + " https://127.0.0.1:" + std::to_string(port) +
                         "/api/v1/renders -H 'Host: study.example.org'";
    std::string text;
    FILE* pipe = ::popen(command.c_str(), "r");
    std::array<char, 256> buffer;
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) text += buffer.data();
    ::pclose(pipe);
    return text;
  }
};

TEST_P(HiddenRequestsThroughNginx, ReachNobody) {
  std::ofstream(place / "hidden") << hidden;
  const auto data = " --data-binary @" + (place / "hidden").string();
  const auto long_header = " -H 'X-Long: " + std::string(8150, 'x') + "'";
  for (const std::string protocol : {"1.1", "2"}) {
    for (const std::string method : {"OPTIONS", "TRACE", "PRI", "FOO", "GET", "POST"}) {
      for (const auto& more : {std::string(), long_header}) {
        const auto answer = curl("--http" + protocol + " -X " + method + data + more);
        ASSERT_TRUE(answer.ends_with(" " + protocol)) << answer;
        EXPECT_GE(std::stoi(answer), 400) << method << " by HTTP/" << protocol;
        const auto next = outside->Get("/openapi.json", as_researcher);
        ASSERT_TRUE(next) << method;
        EXPECT_EQ(next->status, 200) << method << " by HTTP/" << protocol;
        EXPECT_NE(next->body.find("\"openapi\""), std::string::npos) << next->body;
      }
    }
  }
  EXPECT_FALSE(was_called(*server));
}

INSTANTIATE_TEST_SUITE_P(WithItsConnections, HiddenRequestsThroughNginx, testing::Bool(),
                         [](const auto& kind) { return kind.param ? "Shared" : "AsShipped"; });

}  // namespace
}  // namespace penumbra::server::http
