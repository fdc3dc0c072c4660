// Judged by what RFC 9112 says of each form, and by what lets two readers disagree on where a
// request ends.
#include "server/http/request_head.h"

#include <gtest/gtest.h>

#include "server/http/body_framing.h"
#include "server/http/reply.h"

namespace penumbra::server::http {
namespace {

const std::vector<std::string> known{"DELETE", "GET", "HEAD", "POST", "PUT"};

/// State that the head is refused with; 100 where more has to come, 200 where it is taken.
int verdict(const std::string& bytes) {
  RequestHead head;
  try {
    return read_head(bytes, known, head) ? 200 : 100;
  } catch (const Error& error) {
    return status_of(error.code);
  }
}

std::string with(const std::string& fields, const std::string& line = "POST /x HTTP/1.1") {
  return line + "\r\nHost: x\r\n" + fields + "\r\n";
}

TEST(ARequestsHead, IsTakenWhereItIsPlain) {
  EXPECT_EQ(verdict(with("", "GET / HTTP/1.1")), 200);
  EXPECT_EQ(verdict(with("Content-Length: 5\r\n")), 200);
  EXPECT_EQ(verdict(with("content-length:5\r\n")), 200);
  EXPECT_EQ(verdict(with("Transfer-Encoding: Chunked\r\n")), 200);
  EXPECT_EQ(verdict(with("X: \xc3\xa4\tb \r\nEmpty:\r\n")), 200);
  EXPECT_EQ(verdict("GET / HTTP/1.0\r\n\r\n"), 200) << "HTTP/1.0 knows no Host";
  EXPECT_EQ(verdict(with("Content-Length: 0\r\n", "GET / HTTP/1.1")), 200);
}

TEST(ARequestsHead, IsMeasured) {
  RequestHead head;
  const auto bytes = with("Content-Length: 12\r\nExpect: 100-continue\r\n");
  ASSERT_TRUE(read_head(bytes + "rest\r\n\r\n", known, head));
  EXPECT_EQ(head.size, bytes.size());
  EXPECT_EQ(head.content_length, 12u);
  EXPECT_EQ(head.method, "POST");
  EXPECT_TRUE(head.expects_continue);
  EXPECT_TRUE(head.keeps_alive);
  ASSERT_TRUE(read_head(with("Connection: x, CLOSE\r\n"), known, head));
  EXPECT_FALSE(head.keeps_alive);
  ASSERT_TRUE(read_head("GET / HTTP/1.0\r\n\r\n", known, head));
  EXPECT_FALSE(head.keeps_alive);
}

TEST(ARequestsHead, IsAwaitedToItsEnd) {
  const auto whole = with("Content-Length: 5\r\n");
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_EQ(verdict(whole.substr(0, length)), 100) << length;
}

TEST(ARequestsHead, IsRefusedWhereLinesAreNotEndedProperly) {
  EXPECT_EQ(verdict("GET / HTTP/1.1\nHost: x\n\n"), 400);
  EXPECT_EQ(verdict(with("A: b\nContent-Length: 5\r\n")), 400);
  EXPECT_EQ(verdict(with("A: b\rContent-Length: 5\r\n")), 400);
  EXPECT_EQ(verdict(with(std::string("A: b\0c\r\n", 9))), 400);
  EXPECT_EQ(verdict(with("A: \x01\r\n")), 400);
  EXPECT_EQ(verdict("\r\nGET / HTTP/1.1\r\nHost: x\r\n\r\n"), 400);
}

TEST(ARequestsHead, IsRefusedWhereAFieldIsNone) {
  EXPECT_EQ(verdict(with("Content-Length : 5\r\n")), 400);
  EXPECT_EQ(verdict(with(" Content-Length: 5\r\n")), 400) << "a folded line";
  EXPECT_EQ(verdict(with("A: b\r\n\tc\r\n")), 400) << "a folded line";
  EXPECT_EQ(verdict(with(": x\r\n")), 400);
  EXPECT_EQ(verdict(with("nothing\r\n")), 400);
  EXPECT_EQ(verdict(with("A(b): c\r\n")), 400);
}

TEST(ARequestsHead, IsRefusedWhereTheLengthIsDoubtful) {
  for (const std::string value : {"-1", "+5", "0x10", "1e3", "5, 5", "5 5", "", " ", "1.0",
                                  "18446744073709551616", "99999999999999999999999"})
    EXPECT_EQ(verdict(with("Content-Length: " + value + "\r\n")), 400) << value;
  EXPECT_EQ(verdict(with("Content-Length: 5\r\nContent-Length: 5\r\n")), 400);
  EXPECT_EQ(verdict(with("Content-Length: 5\r\nTransfer-Encoding: chunked\r\n")), 400);
  EXPECT_EQ(verdict(with("Transfer-Encoding: chunked\r\ntransfer-encoding: chunked\r\n")), 400);
  for (const std::string value : {"gzip", "gzip, chunked", "chunked, chunked", "xchunked", ""})
    EXPECT_EQ(verdict(with("Transfer-Encoding: " + value + "\r\n")), 400) << value;
  EXPECT_EQ(verdict("POST / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n"), 400);
}

TEST(ARequestsHead, IsRefusedWhereABodyBelongsToNoSuchMethod) {
  for (const std::string method : {"GET", "HEAD"}) {
    EXPECT_EQ(verdict(with("Content-Length: 5\r\n", method + " / HTTP/1.1")), 400) << method;
    EXPECT_EQ(verdict(with("Transfer-Encoding: chunked\r\n", method + " / HTTP/1.1")), 400);
  }
  for (const std::string method : {"OPTIONS", "TRACE", "CONNECT", "PRI", "PATCH", "FOO", "get"})
    EXPECT_EQ(verdict(with("Content-Length: 5\r\n", method + " / HTTP/1.1")), 405) << method;
}

TEST(ARequestsHead, IsRefusedWhereTheFirstLineIsOdd) {
  for (const std::string line :
       {"GET  HTTP/1.1", "GET /", "/ HTTP/1.1", "GET / x HTTP/1.1", "GET / HTTP/1.1 ",
        "GET http://x/ HTTP/1.1", "GET * HTTP/1.1", "GET x HTTP/1.1", "GET / HTTP/2.0",
        "GET / HTTP/1.11", "GET / http/1.1", "G ET / HTTP/1.1", "GET /\tx HTTP/1.1",
        "GET /\xc3\xa4 HTTP/1.1", "GET /#x HTTP/1.1", "G\x01T / HTTP/1.1"})
    EXPECT_EQ(verdict(with("", line)), 400) << line;
}

TEST(ARequestsHead, NeedsOneHost) {
  EXPECT_EQ(verdict("GET / HTTP/1.1\r\n\r\n"), 400);
  EXPECT_EQ(verdict(with("Host: y\r\n")), 400);
}

TEST(ARequestsHead, IsBounded) {
  const auto field = [](std::size_t size) { return "A: " + std::string(size - 3, 'b') + "\r\n"; };
  EXPECT_EQ(verdict(with(field(longest_line))), 200);
  EXPECT_EQ(verdict(with(field(longest_line + 1))), 431);
  EXPECT_EQ(verdict("GET /" + std::string(longest_line, 'a')), 414) << "before its end is seen";
  std::string fields;
  for (std::size_t i = 1; i < most_fields; ++i) fields += "A: b\r\n";
  EXPECT_EQ(verdict(with(fields)), 200);
  EXPECT_EQ(verdict(with(fields + "A: b\r\n")), 431);
  EXPECT_EQ(verdict(with(field(8000) + field(8000) + field(8000) + field(8000))), 200);
  EXPECT_EQ(verdict("GET / HTTP/1.1\r\nHost: x\r\n" + field(8000) + field(8000) + field(8000) +
                    field(8000) + field(8000)),
            431)
      << "before its end is seen";
}

/// Bytes that belong to the body, and how it ended.
std::pair<std::size_t, std::string> framed(const std::string& bytes, std::size_t piece) {
  RequestHead head;
  head.chunked = true;
  BodyFraming framing(head);
  std::size_t taken = 0;
  for (std::size_t start = 0; start < bytes.size(); start += piece) {
    const auto part = std::string_view(bytes).substr(start, piece);
    const auto count = framing.take(part);
    taken += count;
    if (count < part.size()) break;
  }
  return {taken, framing.done() ? "done" : framing.broken() ? "broken" : "open"};
}

TEST(ABody, EndsWhereItsChunksDo) {
  const std::string body = "4\r\nabcd\r\nA;x=y\r\n0123456789\r\n0\r\n\r\n";
  for (const std::size_t piece : {1u, 2u, 3u, 7u, 1000u}) {
    const auto [taken, end] = framed(body + "GET / HTTP/1.1\r\n\r\n", piece);
    EXPECT_EQ(taken, body.size()) << piece;
    EXPECT_EQ(end, "done") << piece;
  }
  EXPECT_EQ(framed("4\r\nab", 1).second, "open");
}

TEST(ABody, OfChunksThatAreNoneIsBroken) {
  for (const std::string body :
       {"-1\r\nx\r\n0\r\n\r\n", "+1\r\nx\r\n", "0x1\r\nx\r\n", "1\nx\n0\n\n", "\r\n", "g\r\n",
        "1 \r\nx\r\n", "1\r\nxy\r\n", "0\r\nTrailer: x\r\n\r\n", "1\r\nx\n", "1\rx\r\n",
        "ffffffffffffffff\r\n", "10000000000000000\r\n"})
    EXPECT_EQ(framed(body, 1).second, "broken") << body;
  EXPECT_EQ(framed("1;" + std::string(1000, 'x'), 1).second, "broken");
}

TEST(ABody, OfALengthIsCounted) {
  RequestHead head;
  head.content_length = 5;
  BodyFraming framing(head);
  EXPECT_EQ(framing.take("abc"), 3u);
  EXPECT_FALSE(framing.done());
  EXPECT_EQ(framing.take("deGET"), 2u);
  EXPECT_TRUE(framing.done());
}

}  // namespace
}  // namespace penumbra::server::http
