#include "tests/http/raw_request.h"
#include "tests/http/running_server.h"

namespace penumbra::server::http {
namespace {

using Abuse = RunningServer;

std::string request(const std::string& headers, const std::string& body = "") {
  return "POST /api/v1/renders HTTP/1.1\r\nHost: x\r\n" + headers + "\r\n" + body;
}

TEST_F(Abuse, TwoLengthsOfOneBodyAreRefusedAndTheConnectionIsClosed) {
  const auto answer =
      send_raw(server->port(), request("Content-Length: 4\r\nTransfer-Encoding: chunked\r\n",
                                       "0\r\n\r\nGET /healthz HTTP/1.1\r\nHost: x\r\n\r\n"));
  EXPECT_EQ(answer.status(), 400);
  EXPECT_TRUE(answer.closed);
  EXPECT_EQ(answer.text.find("HTTP/1.1", 5), std::string::npos)
      << "the rest was taken for a request";
}

TEST_F(Abuse, LengthsThatAreNoNumberAreRefused) {
  for (const std::string length : {"-1", "+5", "0x10", "1e3", "99999999999999999999999"}) {
    const auto answer = send_raw(server->port(), request("Content-Length: " + length + "\r\n"));
    EXPECT_EQ(answer.status(), 400) << length;
    EXPECT_TRUE(answer.closed) << length;
  }
}

TEST_F(Abuse, UnknownEncodingsOfTheTransferAreRefused) {
  EXPECT_EQ(send_raw(server->port(), request("Transfer-Encoding: gzip\r\n")).status(), 400);
}

TEST_F(Abuse, ABodyWhereNoneBelongsIsRefused) {
  const auto answer = send_raw(
      server->port(), "GET /api/v1/scenes HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\n\r\nGET /");
  EXPECT_EQ(answer.status(), 400);
  EXPECT_TRUE(answer.closed);
}

TEST_F(Abuse, ChunkedBodiesAreCounted) {
  std::string chunks;
  const std::string block(60000, ' ');
  for (int i = 0; i < 10; ++i) chunks += "ea60\r\n" + block + "\r\n";
  const auto answer =
      send_raw(server->port(), request("Transfer-Encoding: chunked\r\n", chunks + "0\r\n\r\n"));
  EXPECT_EQ(answer.status(), 413);
}

TEST_F(Abuse, EndlessChunksAreCutOff) {
  std::string chunks;
  const std::string block(1 << 20, 'x');
  for (int i = 0; i < 40; ++i) chunks += "100000\r\n" + block + "\r\n";
  const auto answer = send_raw(server->port(), request("Transfer-Encoding: chunked\r\n", chunks));
  EXPECT_TRUE(answer.status() == 413 || answer.text.empty()) << answer.text;
}

TEST_F(Abuse, NegativeChunksAreRefused) {
  const auto answer =
      send_raw(server->port(), request("Transfer-Encoding: chunked\r\n", "-1\r\nx\r\n0\r\n\r\n"));
  EXPECT_GE(answer.status(), 400);
  EXPECT_LT(answer.status(), 500);
}

TEST_F(Abuse, HugeBodiesAreRefusedBeforeTheyAreSent) {
  const auto answer = send_raw(server->port(), request("Content-Length: 99999999999\r\n"));
  EXPECT_EQ(answer.status(), 413);
  EXPECT_TRUE(answer.closed);
}

TEST_F(Abuse, BombsAreCountedUnpacked) {
  std::string packed(1 << 20, '\0');
  z_stream stream{};
  ASSERT_EQ(::deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string zeros(8 << 20, ' ');
  stream.next_in = reinterpret_cast<Bytef*>(zeros.data());
  stream.avail_in = static_cast<uInt>(zeros.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  ASSERT_EQ(::deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  ::deflateEnd(&stream);
  ASSERT_LT(packed.size(), 64u << 10);
  const auto result =
      client->Post("/api/v1/renders", {{"Content-Encoding", "gzip"}}, packed, "application/json");
  EXPECT_EQ(error_of(result, 413), "too_large");
}

TEST_F(Abuse, DeepJsonIsRefused) {
  const std::string deep = std::string(50000, '[') + std::string(50000, ']');
  const auto result = client->Post("/api/v1/renders", deep, "application/json");
  EXPECT_EQ(error_of(result, 400), "bad_value");
  EXPECT_EQ(field_of(result), "body");
}

TEST_F(Abuse, WhatIsNoJsonIsRefused) {
  for (const std::string text : {"{", "nul", "{\"width\": NaN}", "{\"width\": 1e999}", "\"\xff\""})
    EXPECT_EQ(error_of(client->Post("/api/v1/renders", text, "application/json"), 400), "bad_value")
        << text;
}

TEST_F(Abuse, TextThatIsNoTextIsRefused) {
  EXPECT_EQ(error_of(client->Get("/api/v1/image?scene=%ff%fe&technique=none"), 400), "bad_value");
  EXPECT_EQ(error_of(client->Get("/api/v1/image?scene=a%00b&technique=none"), 400), "bad_value");
  EXPECT_EQ(error_of(client->Get("/api/v1/renders/%ff"), 404), "not_found");
}

TEST_F(Abuse, PathsDoNotLeadOutside) {
  for (const std::string path :
       {"/assets/participant/../../etc/passwd", "/assets/participant/..%2f..%2findex.html",
        "/assets/%2e%2e/README.md", "/assets/participant/%00", "/assets/participant/.hidden"})
    EXPECT_EQ(error_of(client->Get(path), 404), "not_found") << path;
}

TEST_F(Abuse, TooManyHeadersAndTooLongPathsAreRefused) {
  std::string headers;
  for (int i = 0; i < 500; ++i) headers += "X-" + std::to_string(i) + ": y\r\n";
  EXPECT_EQ(
      send_raw(server->port(), "GET /api/v1/scenes HTTP/1.1\r\nHost: x\r\n" + headers + "\r\n")
          .status(),
      431);
  EXPECT_EQ(client->Get("/" + std::string(4000, 'a'))->status, 404);
  EXPECT_GE(
      send_raw(server->port(), "GET /" + std::string(1 << 20, 'a') + " HTTP/1.1\r\n\r\n").status(),
      400);
}

TEST_F(Abuse, LeavesTheServerServing) {
  send_raw(server->port(), "\x16\x03\x01 nonsense\r\n\r\n", 1);
  send_raw(server->port(), "GET / HTTP/9.9\r\n\r\n", 1);
  EXPECT_EQ(client->Get("/api/v1/scenes")->status, 200);
}

}  // namespace
}  // namespace penumbra::server::http
