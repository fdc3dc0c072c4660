#include "server/http/request_head.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

namespace penumbra::server::http {
namespace {

bool is_token(std::string_view text) {
  constexpr std::string_view marks = "!#$%&'*+-.^_`|~";
  return !text.empty() && std::all_of(text.begin(), text.end(), [&](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           marks.find(c) != std::string_view::npos;
  });
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// One of a list of names parted by commas.
bool lists(std::string_view list, std::string_view name) {
  while (true) {
    const auto comma = list.find(',');
    if (same_name(trimmed(list.substr(0, comma)), name)) return true;
    if (comma == std::string_view::npos) return false;
    list.remove_prefix(comma + 1);
  }
}

Error bad_line(const std::string& message) {
  return bad_value("request", message);
}

/// The next line without its end, taken off `rest`; nothing where its end is not there yet.
std::optional<std::string_view> take_line(std::string_view& rest, bool first) {
  const auto end = rest.find('\n');
  const auto line = rest.substr(0, end);
  if (line.size() > longest_line + 1) {
    if (first) throw Error("too_long", "the address must be shorter", "request");
    throw Error("too_many_headers",
                "a header field must be at most " + std::to_string(longest_line) + " bytes");
  }
  if (end == std::string_view::npos) return std::nullopt;
  if (line.empty() || line.back() != '\r') throw bad_line("lines must end in CR LF");
  rest.remove_prefix(end + 1);
  return line.substr(0, line.size() - 1);
}

void read_request_line(std::string_view line, std::span<const std::string> methods,
                       RequestHead& head, bool& old) {
  const auto first = line.find(' ');
  const auto last = line.rfind(' ');
  if (first == std::string_view::npos || first == last)
    throw bad_line("the first line must be a method, a path and HTTP/1.1");
  const auto target = line.substr(first + 1, last - first - 1);
  const auto version = line.substr(last + 1);
  head.method = line.substr(0, first);
  if (!is_token(head.method)) throw bad_line("the method must be a name");
  if (version != "HTTP/1.1" && version != "HTTP/1.0") throw bad_line("only HTTP/1.1 is spoken");
  old = version == "HTTP/1.0";
  const bool visible = std::all_of(target.begin(), target.end(),
                                   [](char c) { return c > ' ' && c < '\x7f' && c != '#'; });
  if (!target.starts_with('/') || !visible) throw bad_line("the address must be a path");
  if (std::find(methods.begin(), methods.end(), head.method) == methods.end())
    throw Error("not_allowed", "this method is not known here", "method");
}

struct Fields {
  std::size_t count = 0;
  std::size_t hosts = 0;
  std::optional<std::string_view> length;
  std::optional<std::string_view> encoding;
  bool close = false;
  bool keep_alive = false;
};

/// Takes a framing field that may appear once.
void take_once(std::optional<std::string_view>& field, std::string_view value) {
  if (field) throw bad_value("Content-Length", "the length of the body is given more than once");
  field = value;
}

void read_field(std::string_view line, Fields& fields, RequestHead& head) {
  if (++fields.count > most_fields)
    throw Error("too_many_headers", "at most " + std::to_string(most_fields) + " header fields");
  const auto colon = line.find(':');
  const auto name = line.substr(0, colon);
  // A name with a space before its colon, and a line that begins with one (a folded line), are read
  // differently by different programs.
  if (colon == std::string_view::npos || !is_token(name))
    throw bad_line("a header field must be a name, a colon and a value");
  const auto value = trimmed(line.substr(colon + 1));
  const bool plain = std::all_of(value.begin(), value.end(), [](char c) {
    return c == '\t' || (static_cast<unsigned char>(c) >= ' ' && c != '\x7f');
  });
  if (!plain) throw bad_line("a header field holds a control character");
  if (same_name(name, "Host")) ++fields.hosts;
  if (same_name(name, "Content-Length")) take_once(fields.length, value);
  if (same_name(name, "Transfer-Encoding")) take_once(fields.encoding, value);
  if (same_name(name, "Connection")) {
    fields.close |= lists(value, "close");
    fields.keep_alive |= lists(value, "keep-alive");
  }
  if (same_name(name, "Expect")) head.expects_continue = same_name(value, "100-continue");
}

void read_framing(const Fields& fields, bool old, RequestHead& head) {
  if (fields.length && fields.encoding)
    throw bad_value("Content-Length", "the length of the body is given more than once");
  if (fields.encoding) {
    if (old || !same_name(*fields.encoding, "chunked"))
      throw bad_value("Transfer-Encoding", "only chunked is known");
    head.chunked = true;
  }
  if (fields.length) {
    const auto* begin = fields.length->data();
    const auto* end = begin + fields.length->size();
    const auto [stop, failure] = std::from_chars(begin, end, head.content_length);
    if (fields.length->empty() || *begin == '-' || failure != std::errc{} || stop != end)
      throw bad_value("Content-Length", "must be a number");
  }
  if (head.has_body() && !may_have_body(head.method))
    throw bad_value("body", "this method takes no body");
}

}  // namespace

bool may_have_body(std::string_view method) {
  constexpr std::array<std::string_view, 4> methods{"POST", "PUT", "DELETE", "PATCH"};
  return std::find(methods.begin(), methods.end(), method) != methods.end();
}

bool read_head(std::string_view bytes, std::span<const std::string> methods, RequestHead& head) {
  head = {};
  std::string_view rest = bytes;
  bool old = false;
  Fields fields;
  auto line = take_line(rest, true);
  if (line) read_request_line(*line, methods, head, old);
  while (line) {
    const auto taken = bytes.size() - rest.size();
    if (taken > longest_head) break;
    line = take_line(rest, false);
    if (line && line->empty()) {
      if (fields.hosts > 1 || (fields.hosts == 0 && !old))
        throw bad_value("Host", "must be given once");
      read_framing(fields, old, head);
      head.size = bytes.size() - rest.size();
      head.keeps_alive = old ? fields.keep_alive && !fields.close : !fields.close;
      return true;
    }
    if (line) read_field(*line, fields, head);
  }
  if (bytes.size() > longest_head)
    throw Error("too_many_headers",
                "the head must be at most " + std::to_string(longest_head) + " bytes");
  return false;
}

}  // namespace penumbra::server::http
