#include "server/cli/table.h"

#include <algorithm>
#include <cstdio>

namespace penumbra::server::cli {
namespace {

/// Characters, not bytes, of UTF-8.
std::size_t length(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

std::string Table::text(bool all_left) const {
  std::vector<std::size_t> widths(rows_.front().size(), 0);
  for (const auto& row : rows_)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], length(row[i]));
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string blank(widths[i] - length(row[i]), ' ');
      line += i == 0 || all_left ? row[i] + blank : blank + row[i];
      line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string number(const nlohmann::json& value, int decimals) {
  if (!value.is_number()) return "-";
  char digits[64];
  std::snprintf(digits, sizeof digits, "%.*f", decimals, value.get<double>());
  return digits;
}

}  // namespace penumbra::server::cli
