#include "figures/text.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace penumbra::figures {

namespace {

/// Advance widths of DejaVu Sans 2.37 for U+0020 to U+007E, thousandths of the size.
constexpr std::array<short, 95> widths{
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361,  318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635,  611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352,  635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,  525, 636, 337, 636, 838};

/// Beyond ASCII: letters of Latin, Greek and Cyrillic as wide as most of them are at most, the rest
/// as wide as a Chinese character.
double other_width(std::string_view sequence) {
  return sequence.size() == 2 ? 0.8 : 1.0;
}

bool may_break_after(char byte) {
  return byte == ' ' || byte == '-' || byte == '_' || byte == '/';
}

/// Pieces that are not torn: words with the character that ends them.
std::vector<std::string> pieces_of(std::string_view text) {
  std::vector<std::string> pieces(1);
  for (const char byte : text) {
    pieces.back() += byte;
    if (may_break_after(byte)) pieces.emplace_back();
  }
  if (pieces.back().empty() && pieces.size() > 1) pieces.pop_back();
  return pieces;
}

std::string without_end_blanks(std::string line) {
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

/// A word that is too long for a line, in parts that fit.
std::vector<std::string> torn(const std::string& word, double width, double size) {
  std::vector<std::string> parts(1);
  std::string_view left = word;
  while (!left.empty()) {
    const std::size_t length = std::max<std::size_t>(1, utf8_length(left));
    const std::string next(left.substr(0, length));
    if (!parts.back().empty() && text_width(parts.back() + next, size) > width)
      parts.emplace_back();
    parts.back() += next;
    left.remove_prefix(length);
  }
  return parts;
}

}  // namespace

std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0u) == 0x80u; };
  const unsigned first = byte(0);
  if (text.empty()) return 0;
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    if (!follows(1) || !follows(2)) return 0;
    if (first == 0xE0 && byte(1) < 0xA0) return 0;
    return first == 0xED && byte(1) > 0x9F ? 0 : 3;  // no surrogates
  }
  if (first >= 0xF0 && first <= 0xF4) {
    if (!follows(1) || !follows(2) || !follows(3)) return 0;
    if (first == 0xF0 && byte(1) < 0x90) return 0;
    return first == 0xF4 && byte(1) > 0x8F ? 0 : 4;
  }
  return 0;
}

std::string escaped(std::string_view text) {
  constexpr std::string_view replacement = "\xEF\xBF\xBD";
  std::string result;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const std::string_view sequence = text.substr(0, std::max<std::size_t>(1, length));
    const char first = text.front();
    if (length == 0 || sequence == "\xEF\xBF\xBE" || sequence == "\xEF\xBF\xBF" ||
        (length == 1 && static_cast<unsigned char>(first) < 0x20 && first != '\t' &&
         first != '\n' && first != '\r'))
      result += replacement;
    else if (first == '&')
      result += "&amp;";
    else if (first == '<')
      result += "&lt;";
    else if (first == '>')
      result += "&gt;";
    else if (first == '"')
      result += "&quot;";
    else if (first == '\'')
      result += "&#39;";
    else
      result += sequence;
    text.remove_prefix(sequence.size());
  }
  return result;
}

double text_width(std::string_view text, double size) {
  double em = 0.0;
  while (!text.empty()) {
    const std::size_t length = std::max<std::size_t>(1, utf8_length(text));
    const auto first = static_cast<unsigned char>(text.front());
    if (first >= 0x20 && first < 0x7F)
      em += widths[first - 0x20] / 1000.0;
    else
      em += other_width(text.substr(0, length));
    text.remove_prefix(length);
  }
  return em * size;
}

std::vector<std::string> wrapped(std::string_view text, double width, double size) {
  std::vector<std::string> lines(1);
  const auto add = [&](const std::string& piece) {
    const std::string longer = lines.back() + piece;
    if (!lines.back().empty() && text_width(without_end_blanks(longer), size) > width)
      lines.push_back(piece);
    else
      lines.back() = longer;
  };
  for (const std::string& piece : pieces_of(text)) {
    if (text_width(without_end_blanks(piece), size) <= width) {
      add(piece);
      continue;
    }
    for (const std::string& part : torn(piece, width, size)) add(part);
  }
  for (std::string& line : lines) line = without_end_blanks(line);
  return lines;
}

std::string fixed_text(double value, int decimals) {
  std::array<char, 400> buffer{};  // a double has at most 309 digits before the point
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, decimals);
  std::string text(buffer.data(), end.ptr);
  if (text.starts_with('-') && text.find_first_of("123456789") == std::string::npos)
    text.erase(0, 1);
  return text;
}

std::string number_text(double value, int decimals) {
  std::string text = fixed_text(value, decimals);
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string shown_number(double value, int decimals) {
  std::string text = fixed_text(value, decimals);
  if (text.starts_with('-')) text.replace(0, 1, "\u2212");
  return text;
}

}  // namespace penumbra::figures
