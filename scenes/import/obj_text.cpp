#include <charconv>
#include <cmath>

#include "renderer/error.h"
#include "scenes/import/obj.h"
#include "scenes/text.h"

namespace penumbra::scenes::obj {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0';
}

/// Adds the words of one line up to a comment; a # inside a word is part of it.
void split(std::string_view line, std::vector<std::string_view>& words) {
  std::size_t at = 0;
  while (at < line.size()) {
    while (at < line.size() && is_space(line[at])) ++at;
    if (at == line.size() || line[at] == '#') return;
    const std::size_t begin = at;
    while (at < line.size() && !is_space(line[at])) ++at;
    words.push_back(line.substr(begin, at - begin));
  }
}

/// Text up to the end of line at or after `at`, which moves behind it: \n, \r or both.
std::string_view next_line(std::string_view text, std::size_t& at) {
  const std::size_t begin = at;
  while (at < text.size() && text[at] != '\n' && text[at] != '\r') ++at;
  const std::string_view line = text.substr(begin, at - begin);
  if (at < text.size()) at += text.substr(at, 2) == "\r\n" ? 2 : 1;
  return line;
}

/// Whether the next line belongs to this one, whose last backslash is then cut; one in a comment
/// says nothing.
bool goes_on(std::string_view& line) {
  std::size_t end = line.size();
  while (end > 0 && is_space(line[end - 1])) --end;
  if (end == 0 || line[end - 1] != '\\') return false;
  for (std::size_t i = 0; i < end; ++i)
    if (line[i] == '#' && (i == 0 || is_space(line[i - 1]))) return false;
  line = line.substr(0, end - 1);
  return true;
}

}  // namespace

void for_each_statement(
    std::string_view text,
    const std::function<void(const std::vector<std::string_view>& words, std::size_t line)>& take) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw unreadable("the file is UTF-16 text: it must be saved as UTF-8");
  std::vector<std::string_view> words;
  std::size_t at = 0, line_number = 0;
  while (at < text.size()) {
    words.clear();
    const std::size_t first = ++line_number;
    std::string_view line = next_line(text, at);
    while (goes_on(line) && at < text.size()) {
      split(line, words);
      line = next_line(text, at);
      ++line_number;
    }
    split(line, words);
    if (!words.empty()) take(words, first);
  }
}

std::string rest_of(const std::vector<std::string_view>& words, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < words.size(); ++i) {
    // Words of one line keep the space between them.
    const char* before = i > first ? words[i - 1].data() + words[i - 1].size() : nullptr;
    const auto space = before != nullptr && before < words[i].data()
                           ? static_cast<std::size_t>(words[i].data() - before)
                           : 0;
    const std::string_view between(before, space);
    if (i > first) text += between.find_first_of("\r\n\\") == between.npos ? between : " ";
    text += words[i];
  }
  return text;
}

double number_of(std::string_view word, std::size_t line) {
  const auto refuse = [&](const char* why) {
    return unreadable("line " + std::to_string(line) + ": " + in_quotes(std::string(word)) + why);
  };
  std::string digits(word);
  while (!digits.empty() && (digits.back() == ',' || digits.back() == ';')) digits.pop_back();
  if (digits.find('.') == std::string::npos)
    if (const std::size_t comma = digits.find(','); comma != std::string::npos) digits[comma] = '.';
  const char* begin = digits.data();
  const char* end = begin + digits.size();
  if (digits.starts_with('+')) ++begin;
  double value = 0.0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error == std::errc::result_out_of_range) {
    // Too small to tell from zero is zero.
    if (digits.find("e-") != std::string::npos || digits.find("E-") != std::string::npos)
      return 0.0;
    throw refuse(" is too large");
  }
  if (error != std::errc{} || stop != end) throw refuse(" is no number");
  if (!std::isfinite(value)) throw refuse(" is not finite");
  return value;
}

}  // namespace penumbra::scenes::obj
