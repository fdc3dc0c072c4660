#include "server/http/body_framing.h"

#include <algorithm>
#include <charconv>

namespace penumbra::server::http {
namespace {

constexpr std::size_t longest_chunk_line = 256;      // size and extensions; bytes
constexpr std::uint64_t largest_chunk = 1ull << 40;  // bytes

}  // namespace

BodyFraming::BodyFraming(const RequestHead& head) : left(head.content_length) {
  state = head.chunked ? State::chunk_line : left > 0 ? State::counted : State::done;
}

std::size_t BodyFraming::take(std::string_view bytes) {
  std::size_t taken = 0;
  while (taken < bytes.size() && !done() && !broken()) {
    if (state != State::counted && state != State::chunk) {
      take_line_byte(bytes[taken++]);
      continue;
    }
    const auto count = std::min<std::uint64_t>(left, bytes.size() - taken);
    taken += static_cast<std::size_t>(count);
    left -= count;
    if (left == 0) state = state == State::counted ? State::done : State::chunk_end;
  }
  return taken;
}

void BodyFraming::take_line_byte(char byte) {
  line += byte;
  if (line.size() > longest_chunk_line) {
    state = State::broken;
    return;
  }
  if (byte != '\n') return;
  if (!line.ends_with("\r\n") || line.find('\r') != line.size() - 2) {
    state = State::broken;
  } else if (state == State::chunk_line) {
    end_chunk_line();
  } else if (line.size() > 2) {
    state = State::broken;  // more bytes than the chunk's size, or a trailer
  } else {
    state = state == State::last_end ? State::done : State::chunk_line;
  }
  line.clear();
}

void BodyFraming::end_chunk_line() {
  const auto* begin = line.data();
  const auto [stop, failure] = std::from_chars(begin, begin + line.size(), left, 16);
  const bool number = *begin != '-' && failure == std::errc{} && left <= largest_chunk;
  // Extensions are skipped: they follow a semicolon.
  if (!number || (*stop != ';' && *stop != '\r'))
    state = State::broken;
  else
    state = left == 0 ? State::last_end : State::chunk;
}

}  // namespace penumbra::server::http
