// Heads of requests and the bodies behind them. The verdict on the same bytes is the same however
// they arrive: all at once, or cut anywhere.
#include "server/http/request_head.h"

#include <cstdlib>
#include <optional>
#include <vector>

#include "server/http/body_framing.h"
#include "tests/fuzz/target.h"

namespace {

using namespace penumbra::server::http;

const std::vector<std::string> methods = {"GET", "HEAD", "POST", "PUT", "DELETE", "PATCH"};

struct Verdict {
  std::string refused;  ///< code
  std::optional<RequestHead> head;

  bool operator==(const Verdict& other) const {
    return refused == other.refused && head.has_value() == other.head.has_value() &&
           (!head || (head->size == other.head->size && head->method == other.head->method &&
                      head->chunked == other.head->chunked &&
                      head->content_length == other.head->content_length));
  }
};

Verdict verdict_on(std::string_view bytes) {
  Verdict verdict;
  try {
    RequestHead head;
    if (read_head(bytes, methods, head)) verdict.head = head;
  } catch (const penumbra::Error& error) {
    verdict.refused = error.code;
  }
  return verdict;
}

void check(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string bytes = penumbra::fuzz::text_of(data + 1, size - 1);
  const Verdict whole = verdict_on(bytes);
  // The first byte says where the bytes are cut.
  const std::size_t cut = bytes.size() * data[0] / 256;
  const Verdict part = verdict_on(std::string_view(bytes).substr(0, cut));
  if (part.head || !part.refused.empty()) check(part == whole);
  if (!whole.head) return 0;

  const RequestHead& head = *whole.head;
  check(head.size <= bytes.size() && head.size <= longest_head);
  check(!head.has_body() || may_have_body(head.method));
  check(!(head.chunked && head.content_length > 0));
  const std::string_view rest = std::string_view(bytes).substr(head.size);
  BodyFraming at_once(head);
  const std::size_t taken = at_once.take(rest);
  check(taken <= rest.size());
  BodyFraming in_two(head);
  const std::size_t half = rest.size() * data[0] / 256;
  std::size_t in_pieces = in_two.take(rest.substr(0, half));
  if (in_pieces == half) in_pieces += in_two.take(rest.substr(half));
  check(at_once.done() == in_two.done() && at_once.broken() == in_two.broken());
  if (!at_once.broken()) check(in_pieces == taken);
  return 0;
}
