// Clients that are slow, many or endless, against a listener with short patience.
#include "server/http/listener.h"

#include <gtest/gtest.h>

#include "server/http/reply.h"
#include "server/http/request_stream.h"
#include "tests/http/raw_request.h"

namespace penumbra::server::http {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class AListener : public testing::Test {
 protected:
  void SetUp() override {
    ListenerOptions options;
    options.threads = 4;
    options.connections = 8;
    options.methods = {"GET", "HEAD", "POST"};
    options.limits.idle = options.limits.head = options.limits.patience = milliseconds(600);
    options.limits.farewell = milliseconds(300);
    options.refusal = [methods = options.methods](const Error& error, bool with_body) {
      return refusal_text(error, methods, with_body);
    };
    listener = std::make_unique<Listener>(options);
    listener->Get("/small", [](const httplib::Request&, httplib::Response& response) {
      response.set_content("small", "text/plain");
    });
    listener->Get("/large", [](const httplib::Request&, httplib::Response& response) {
      response.set_content(std::string(large, 'x'), "text/plain");
    });
    listener->Post("/body", [](const httplib::Request&, httplib::Response& response,
                               const httplib::ContentReader& reader) {
      std::size_t size = 0;
      reader([&](const char*, std::size_t length) {
        size += length;
        return true;
      });
      response.set_content(std::to_string(size), "text/plain");
    });
    port = listener->bind("127.0.0.1", 0, "port");
    listener->start();
  }
  void TearDown() override { listener->finish(); }

  /// Sends the bytes one by one; returns the seconds until the server closed.
  double trickle(RawConnection& connection, const std::string& bytes) const {
    const auto start = Clock::now();
    for (const char byte : bytes) {
      if (!connection.send(std::string(1, byte))) return seconds_since(start);
      if (seconds_since(start) > 8.0) return 1e9;
      std::this_thread::sleep_for(milliseconds(20));
    }
    return 1e9;
  }

  void expect_answer() const {
    const auto start = Clock::now();
    const auto answer =
        send_raw(port, "GET /small HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
    EXPECT_EQ(answer.status(), 200) << answer.text;
    EXPECT_LT(seconds_since(start), 1.0);
  }

  static constexpr std::size_t large = 64 << 20;
  std::unique_ptr<Listener> listener;
  int port = 0;
};

TEST_F(AListener, CutsHeadsThatComeByteByByte) {
  RawConnection connection(port);
  EXPECT_LT(trickle(connection, "GET /small HTTP/1.1\r\nHost: " + std::string(1000, 'x')), 4.0);
  RawConnection told(port);
  told.send("GET /small HTTP/1.1\r\n");
  const auto answer = told.read(4.0);
  EXPECT_EQ(answer.status(), 408) << answer.text;
  EXPECT_TRUE(answer.closed);
}

TEST_F(AListener, CutsBodiesThatComeByteByByte) {
  for (const std::string size : {"1000", "1000000"}) {  // gathered before a thread reads, or not
    RawConnection connection(port);
    connection.send("POST /body HTTP/1.1\r\nHost: x\r\nContent-Length: " + size + "\r\n\r\n");
    EXPECT_LT(trickle(connection, std::string(1000, 'x')), 4.0) << size;
  }
  expect_answer();
}

TEST_F(AListener, LetsABurstBuyNoSilence) {
  RawConnection connection(port);
  connection.send("POST /body HTTP/1.1\r\nHost: x\r\nContent-Length: 100000000\r\n\r\n" +
                  std::string(20 << 20, 'x'));
  const auto start = Clock::now();
  connection.read(6.0);
  EXPECT_LT(seconds_since(start), 5.0);
}

TEST_F(AListener, CutsReadersThatTakeTooLittle) {
  RawConnection connection(port);
  connection.send("GET /large HTTP/1.1\r\nHost: x\r\n\r\n");
  std::size_t taken = 0;
  for (int i = 0; i < 30; ++i) {  // 20 KB/s in pieces that the system tells late of
    taken += connection.read(0.0, 200).text.size();
    std::this_thread::sleep_for(milliseconds(100));
  }
  taken += connection.read(1.0).text.size();
  EXPECT_LT(taken, large);
}

TEST_F(AListener, ServesReadersThatAreSlowButRead) {
  RawConnection connection(port);
  connection.send("GET /large HTTP/1.1\r\nHost: x\r\n\r\n");
  std::size_t taken = 0;
  for (int i = 0; i < 20; ++i) {  // some 5 MB/s for a second, then the rest
    taken += connection.read(0.5, 256 << 10).text.size();
    std::this_thread::sleep_for(milliseconds(50));
  }
  taken += connection.read(1.0).text.size();
  EXPECT_GT(taken, large);
}

TEST_F(AListener, EndsTheLongestWaitingForANewClient) {
  std::vector<std::unique_ptr<RawConnection>> idle;
  for (int i = 0; i < 20; ++i) {
    idle.push_back(std::make_unique<RawConnection>(port));
    idle.back()->send("GET /small HTTP/1.1\r\n");
    expect_answer();
  }
  EXPECT_TRUE(idle.front()->read(0.1).closed || !idle.front()->send("x"));
}

TEST_F(AListener, SpendsNoThreadOnUnfinishedRequests) {
  std::vector<std::unique_ptr<RawConnection>> slow;
  for (int i = 0; i < 7; ++i) {  // threads are 4
    slow.push_back(std::make_unique<RawConnection>(port));
    slow.back()->send("POST /body HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\nxxx");
  }
  expect_answer();
}

TEST_F(AListener, KeepsAConnectionForFurtherRequests) {
  RawConnection connection(port);
  for (int i = 0; i < 3; ++i) {
    connection.send(
        "POST /body HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n"
        "3\r\nabc\r\n0\r\n\r\n");
    const auto answer = connection.read(0.2);
    EXPECT_EQ(answer.status(), 200) << answer.text;
    EXPECT_TRUE(answer.text.ends_with("\r\n\r\n3")) << answer.text;
    EXPECT_FALSE(answer.closed);
  }
  EXPECT_TRUE(connection.read(4.0).closed) << "an idle one ends";
}

TEST_F(AListener, FinishesWhatRunsAndNothingElse) {
  RawConnection idle(port);
  RawConnection started(port);
  started.send("GET /small HT");
  std::this_thread::sleep_for(milliseconds(50));
  const auto start = Clock::now();
  listener->finish();
  EXPECT_LT(seconds_since(start), 2.0);
  EXPECT_TRUE(idle.read(1.0).closed);
  RawConnection late(port);
  EXPECT_EQ(late.read(0.2).text, "");
}

}  // namespace
}  // namespace penumbra::server::http
