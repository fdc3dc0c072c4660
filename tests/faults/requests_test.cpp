// Requests that no well-behaved client sends.
#include <zlib.h>

#include <regex>

#include "tests/faults/ledger.h"
#include "tests/faults/people.h"
#include "tests/http/raw_request.h"

namespace penumbra::faults {
namespace {

using server::http::RawAnswer;
using server::http::send_raw;

constexpr std::size_t megabyte = 1 << 20;

/// One server for all of them: each also shows that it went on serving after the one before.
class Requests : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<server::TemporaryFolder>();
    ServerOptions options;
    options.data = folder->path / "data";
    server = std::make_unique<ServerProcess>(options);
  }
  static void TearDownTestSuite() {
    server.reset();
    folder.reset();
  }
  void TearDown() override {
    const auto answer = server->client().Get("/api/v1/scenes");
    ASSERT_TRUE(answer) << server->log();
    EXPECT_EQ(answer->status, 200);
  }

  static std::string head(const std::string& method, const std::string& headers,
                          const std::string& path = "/api/v1/renders") {
    return method + " " + path + " HTTP/1.1\r\nHost: x\r\n" + headers + "\r\n";
  }
  static json error_of(const std::string& body) {
    const auto document = json::parse(body, nullptr, false);
    return document.is_object() ? document.value("error", json::object()) : json::object();
  }

  static std::unique_ptr<server::TemporaryFolder> folder;
  static std::unique_ptr<ServerProcess> server;
};
std::unique_ptr<server::TemporaryFolder> Requests::folder;
std::unique_ptr<ServerProcess> Requests::server;

TEST_F(Requests, HugePicturesAreRefusedBeforeTheyTakeMemory) {
  Fault fault(13, "pictures of 100,000 x 100,000 pixels");
  server->forget_peak();
  const auto before = server->resident();
  for (const std::string size : {"100000", "4294967295", "4294967296", "99999999999999999999"}) {
    ++fault.tries;
    const auto body = "{\"scene\":\"boxes\",\"technique\":\"none\",\"width\":" + size +
                      ",\"height\":" + size + "}";
    const auto result = server->client().Post("/api/v1/renders", body, "application/json");
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 400) << result->body;
    EXPECT_EQ(error_of(result->body).value("field", ""), "width");
  }
  EXPECT_LT(server->peak(), before + 30 * megabyte);
  fault.did << "each 400 naming the field, " << (server->peak() - before) / 1024 << " KiB more";
}

TEST_F(Requests, OddNumbersAreRefusedByTheNameOfTheirField) {
  Fault fault(14, "NaN, infinite, negative and overflowing numbers in every parameter");
  const auto list = server->client().Get("/api/v1/techniques");
  ASSERT_TRUE(list);
  auto client = server->client();
  const json techniques = json::parse(list->body)["techniques"];
  for (const auto& technique : techniques) {
    const auto id = technique["id"].get<std::string>();
    const json schema = technique.value("parameters", json::object());
    const json properties = schema.contains("properties") ? schema["properties"] : json::object();
    for (const auto& [name, property] : properties.items())
      for (const char* value :
           {"NaN", "Infinity", "-Infinity", "1e999", "-1e300", "99999999999999"}) {
        if (!property.contains("maximum")) continue;
        ++fault.tries;
        const auto result =
            client.Get("/api/v1/plan?scene=half-plane&technique=" + id + "&" + name + "=" + value);
        ASSERT_TRUE(result) << id << " " << name << "=" << value;
        EXPECT_EQ(result->status, 400) << id << " " << name << "=" << value << result->body;
        const auto field = error_of(result->body).value("field", "");
        EXPECT_NE(field.find(name), std::string::npos) << id << " " << name << ": " << field;
        // Where it is to be drawn, too; and the next good request is served.
        const auto drawn =
            client.Get("/api/v1/image?scene=half-plane&width=16&height=16&technique=" + id + "&" +
                       name + "=" + value);
        ASSERT_TRUE(drawn) << id << " " << name << "=" << value;
        EXPECT_EQ(drawn->status, 400) << id << " " << name << "=" << value << drawn->body;
      }
    const auto good = client.Get("/api/v1/image?scene=half-plane&light_samples=4&technique=" + id +
                                 "&width=16&height=16");
    ASSERT_TRUE(good) << id;
    EXPECT_EQ(good->status, 200) << id << good->body;
  }
  EXPECT_GT(fault.tries, 300);
  fault.did << "each 400 naming the parameter, and the next picture of the technique was drawn";
}

TEST_F(Requests, DeepAndHugeJsonIsRefused) {
  Fault fault(15, "deep and huge JSON");
  const std::vector<std::pair<std::string, int>> bodies = {
      {std::string(100000, '['), 400},
      {std::string(50000, '[') + std::string(50000, ']'), 400},
      {"{\"a\":" + std::string(60, '{') + "}", 400},
      {"{\"scene\":\"" + std::string(20 * megabyte, 'x') + "\"}", 413},
  };
  for (const auto& [body, status] : bodies) {
    ++fault.tries;
    const auto result = server->client().Post("/api/v1/renders", body, "application/json");
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, status) << result->body.substr(0, 200);
  }
  fault.did << "400 and 413";
}

TEST_F(Requests, BombsAreCountedUnpacked) {
  Fault fault(16, "half a megabyte that unpacks to 500 MB");
  std::string packed;
  z_stream stream{};
  ASSERT_EQ(::deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string zeros(megabyte, ' ');
  std::string out(megabyte, '\0');
  for (int i = 0; i < 500; ++i) {
    stream.next_in = reinterpret_cast<Bytef*>(zeros.data());
    stream.avail_in = static_cast<uInt>(zeros.size());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(out.data());
      stream.avail_out = static_cast<uInt>(out.size());
      ::deflate(&stream, i == 499 ? Z_FINISH : Z_NO_FLUSH);
      packed.append(out.data(), out.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  }
  ::deflateEnd(&stream);
  server->forget_peak();
  const auto before = server->resident();
  ++fault.tries;
  const auto result = server->client().Post("/api/v1/renders", {{"Content-Encoding", "gzip"}},
                                            packed, "application/json");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 413) << result->body;
  EXPECT_LT(server->peak(), before + 40 * megabyte);
  fault.did << "413, " << (server->peak() - before) / 1024 << " KiB more";
}

TEST_F(Requests, BodiesThatLieAboutTheirLengthAreRefusedAndTheConnectionCloses) {
  Fault fault(17, "endless and negative chunks, two lengths of one body");
  const std::string second = "GET /api/v1/scenes HTTP/1.1\r\nHost: x\r\n\r\n";
  const std::vector<std::string> heads = {
      "Content-Length: 4\r\nTransfer-Encoding: chunked\r\n",
      "Content-Length: 4\r\nContent-Length: 5\r\n",
      "Content-Length: 4, 5\r\n",
      "Content-Length: -1\r\n",
      "Content-Length: +4\r\n",
      "Content-Length: 0x4\r\n",
      "Content-Length: 99999999999999999999\r\n",
      "Transfer-Encoding: gzip\r\n",
      "Transfer-Encoding: chunked, chunked\r\n",
      "Transfer-Encoding: xchunked\r\n",
      "Transfer-Encoding : chunked\r\n",
      "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n",
  };
  for (const auto& lines : heads) {
    ++fault.tries;
    const auto answer = send_raw(server->port(), head("POST", lines) + "0\r\n\r\n" + second);
    EXPECT_TRUE(answer.status() == 400 || answer.status() == 413 || answer.status() == 501)
        << lines << answer.text;
    EXPECT_TRUE(answer.closed) << lines;
    EXPECT_EQ(answer.text.find("HTTP/1.1", 5), std::string::npos) << lines << answer.text;
  }
  for (const std::string chunk :
       {"-1\r\nx\r\n", "ffffffffffffffff\r\nx\r\n", "g\r\nx\r\n", "\r\n\r\n"}) {
    ++fault.tries;
    const auto answer = send_raw(
        server->port(), head("POST", "Transfer-Encoding: chunked\r\n") + chunk + second, 3);
    EXPECT_TRUE(answer.status() >= 400 && answer.status() < 500) << chunk << answer.text;
    EXPECT_EQ(answer.text.find("\"scenes\""), std::string::npos) << chunk;
  }
  ++fault.tries;
  std::string endless;
  const std::string block = "100000\r\n" + std::string(megabyte, 'x') + "\r\n";
  for (int i = 0; i < 40; ++i) endless += block;
  server->forget_peak();
  const auto before = server->resident();
  const auto answer =
      send_raw(server->port(), head("POST", "Transfer-Encoding: chunked\r\n") + endless);
  EXPECT_TRUE(answer.status() == 413 || answer.text.empty()) << answer.text;
  EXPECT_LT(server->peak(), before + 40 * megabyte);
  fault.did << "refused and closed, nothing that followed was read as a request";
}

/// Status lines in what came back.
std::ptrdiff_t answers_in(const std::string& text) {
  const std::regex line("HTTP/1\\.[01] [0-9]{3} ");
  return std::distance(std::sregex_iterator(text.begin(), text.end(), line),
                       std::sregex_iterator());
}

TEST_F(Requests, NothingBehindARefusedHeadIsReadAsARequest) {
  Fault fault(0, "request smuggling: bytes behind a refused head");
  const std::string second = "GET /api/v1/scenes HTTP/1.1\r\nHost: x\r\n\r\n";
  const std::string length = "Content-Length: " + std::to_string(second.size()) + "\r\n";
  std::vector<std::string> heads;
  for (const char* method : {"OPTIONS", "TRACE", "CONNECT", "PRI", "HEAD", "FOO", "GET", "get"})
    heads.push_back(head(method, length));
  heads.push_back(head("POST", "X-Long: " + std::string(9000, 'y') + "\r\n" + length));
  heads.push_back(head("POST", " folded: x\r\n" + length));
  heads.push_back(head("POST", "No colon\r\n" + length));
  heads.push_back("POST /api/v1/renders HTTP/9.9\r\nHost: x\r\n" + length + "\r\n");
  heads.push_back("POST  /api/v1/renders HTTP/1.1\r\nHost: x\r\n" + length + "\r\n");
  for (const auto& bytes : heads) {
    ++fault.tries;
    const auto answer = send_raw(server->port(), bytes + second);
    EXPECT_GE(answer.status(), 400) << bytes.substr(0, 60) << answer.text;
    EXPECT_TRUE(answer.closed) << bytes.substr(0, 60);
    EXPECT_EQ(answers_in(answer.text), 1) << bytes.substr(0, 60) << answer.text;
  }
  fault.did << "closed after one answer each time";
}

/// Sends `begin` once and `more` again and again, up to `total` bytes or until it is cut off;
/// the bytes that were taken.
std::size_t pour(int port, const std::string& begin, const std::string& more, std::size_t total) {
  const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const timeval patience{5, 0};
  ::setsockopt(descriptor, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  std::size_t sent = 0;
  if (::connect(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
    std::string next = begin;
    while (sent < total) {
      const auto count = ::send(descriptor, next.data(), next.size(), MSG_NOSIGNAL);
      if (count <= 0) break;
      sent += static_cast<std::size_t>(count);
      next = next.substr(static_cast<std::size_t>(count));
      if (next.empty()) next = more;
    }
  }
  ::close(descriptor);
  return sent;
}

TEST_F(Requests, HeadsAreBounded) {
  Fault fault(18, "10,000 header fields, lines of a megabyte, heads without an end");
  std::string many;
  for (int i = 0; i < 10000; ++i) many += "X-" + std::to_string(i) + ": y\r\n";
  const std::string line(megabyte, 'a');
  for (const auto& bytes :
       {head("GET", many, "/api/v1/scenes"), head("GET", "X: " + line + "\r\n", "/api/v1/scenes"),
        head("GET", "", "/" + line)}) {
    ++fault.tries;
    const auto answer = send_raw(server->port(), bytes);
    // A client that goes on sending may be cut off before it reads the answer.
    EXPECT_TRUE(answer.status() >= 400 || answer.text.empty()) << answer.text;
  }
  server->forget_peak();
  const auto before = server->resident();
  std::string fields;
  for (int i = 0; i < 3000; ++i) fields += "X-" + std::to_string(i) + ": some value\r\n";
  const std::vector<std::pair<std::string, std::string>> endless = {
      {"GET /api/v1/scenes HTTP/1.1\r\n", fields},
      {"GET /api/v1/scenes HTTP/1.1\r\nX: ", std::string(65536, 'x')},
      {"GET /", std::string(65536, 'x')},
      {"PRI /api/v1/scenes/x HTTP/1.1\r\nHost: x\r\nContent-Length: 999999999\r\n\r\n",
       std::string(65536, 'x')},
      {"FOO / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n",
       "10000\r\n" + std::string(65536, 'x') + "\r\n"},
  };
  for (const auto& [begin, more] : endless)
    for (const int port : {server->port(), server->ops_port()}) {
      ++fault.tries;
      pour(port, begin, more, 60 * megabyte);
    }
  EXPECT_LT(server->peak(), before + 50 * megabyte);
  fault.did << "refused; " << (server->peak() - std::min(before, server->peak())) / megabyte
            << " MiB more at most";
}

/// Connections that send a head byte by byte and never end it.
class SlowClients {
 public:
  SlowClients(int port, int count) {
    for (int i = 0; i < count; ++i) {
      const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_port = htons(static_cast<std::uint16_t>(port));
      address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      if (::connect(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0)
        descriptors.push_back(descriptor);
      else
        ::close(descriptor);
    }
    thread = std::thread([this] {
      const std::string text = "GET /api/v1/scenes HTTP/1.1\r\nHost: x\r\nX-Slow: ";
      for (std::size_t at = 0; !stopping; ++at) {
        const char byte = at < text.size() ? text[at] : 'x';
        for (const int descriptor : descriptors) ::send(descriptor, &byte, 1, MSG_NOSIGNAL);
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
    });
  }
  ~SlowClients() {
    stopping = true;
    thread.join();
    for (const int descriptor : descriptors) ::close(descriptor);
  }
  std::size_t size() const { return descriptors.size(); }

 private:
  std::vector<int> descriptors;
  std::atomic<bool> stopping = false;
  std::thread thread;
};

/// Longest of some calls on fresh connections, seconds.
double longest_call(const ServerProcess& server) {
  double longest = 0;
  for (int i = 0; i < 20; ++i) {
    const Stopwatch watch;
    const auto answer = server.client().Get("/api/v1/scenes");
    EXPECT_TRUE(answer && answer->status == 200);
    longest = std::max(longest, watch.seconds());
  }
  return longest;
}

TEST_F(Requests, SlowClientsKeepOthersFromNothing) {
  Fault fault(19, "600 clients that send a byte now and then");
  const double alone = longest_call(*server);
  const SlowClients slow(server->port(), 600);
  const SlowClients slow_operations(server->ops_port(), 30);
  fault.tries = static_cast<int>(slow.size());
  EXPECT_EQ(slow.size(), 600u);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const double beside = longest_call(*server);
  const Stopwatch watch;
  const auto health = server->operations().Get("/healthz");
  ASSERT_TRUE(health);
  EXPECT_EQ(health->status, 200);
  const double health_s = watch.seconds();
  // A tenth of a second on a quiet machine; a loaded one takes what it takes alone, several times.
  EXPECT_LT(beside, std::max(0.1, 10 * alone));
  EXPECT_LT(health_s, 1.0);
  fault.did << "the slowest of 20 honest calls took " << static_cast<int>(beside * 1000)
            << " ms (alone " << static_cast<int>(alone * 1000) << "), health "
            << static_cast<int>(health_s * 1000) << " ms";
}

TEST_F(Requests, SlowReadersShareOneCopyAndAreCutOff) {
  Fault fault(20, "40 clients that do not read a large picture");
  const json request = {
      {"scene", "half-plane"}, {"technique", "none"}, {"width", 1024}, {"height", 1024}};
  const auto posted = server->client().Post("/api/v1/renders", request.dump(), "application/json");
  ASSERT_TRUE(posted);
  const std::string at = "/api/v1/renders/" + json::parse(posted->body)["id"].get<std::string>();
  ASSERT_EQ(json::parse(server->client().Get(at + "?wait_s=60")->body)["status"], "done");
  const auto whole = server->client().Get(at + "/image.exr");
  ASSERT_TRUE(whole);
  ASSERT_EQ(whole->status, 200);
  const auto size = whole->body.size();
  server->forget_peak();
  const auto before = server->resident();
  std::vector<int> readers;
  for (int i = 0; i < 40; ++i) {
    const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
    const int small = 4096;
    ::setsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(server->port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ASSERT_EQ(::connect(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    const auto bytes = head("GET", "", at + "/image.exr");
    ::send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    readers.push_back(descriptor);
    ++fault.tries;
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_LT(longest_call(*server), 2.0);
  EXPECT_LT(server->peak(), before + 20 * size);
  fault.did << "a file of " << size / 1024 << " KiB took "
            << (server->peak() - std::min(before, server->peak())) / 1024
            << " KiB for all of them; others were served";
  for (const int descriptor : readers) ::close(descriptor);
}

}  // namespace
}  // namespace penumbra::faults
