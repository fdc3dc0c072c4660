#include "experiments/report/page.h"

#include <charconv>
#include <cmath>
#include <span>

#include "figures/text.h"
#include "renderer/embedded_file.h"
#include "scenes/base64.h"

namespace penumbra::experiments {

std::span<const EmbeddedFile> page_files();  // page.css and page.js

namespace {

using figures::escaped;

/// Longer tables can be filtered.
constexpr std::size_t most_rows_at_a_glance = 12;

std::string file_that_ends(const char* ending) {
  for (const EmbeddedFile& file : page_files())
    if (file.path.ends_with(ending)) return std::string(file.text);
  return {};
}

}  // namespace

Cell::Cell(double value, int decimals)
    : text(std::isfinite(value) ? figures::shown_number(value, decimals) : "–"),
      is_number(std::isfinite(value)),
      number(value) {}

void Page::heading(const std::string& text) {
  body_ += "<h2>" + escaped(text) + "</h2>\n";
}

void Page::paragraph(const std::string& text) {
  body_ += "<p>" + escaped(text) + "</p>\n";
}

void Page::facts(const std::vector<std::pair<std::string, std::string>>& list) {
  body_ += "<dl>";
  for (const auto& [name, value] : list)
    body_ += "<dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd>\n";
  body_ += "</dl>\n";
}

void Page::figure(const std::string& svg, const std::string& caption) {
  body_ += "<figure>" + svg + "<figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

void Page::table(const std::string& caption, const std::vector<std::string>& columns,
                 const std::vector<std::vector<Cell>>& rows) {
  body_ += "<div class=\"table\" tabindex=\"0\">";
  if (rows.size() > most_rows_at_a_glance)
    body_ += "<label>Rows that contain <input type=\"search\"></label>";
  body_ += "<table><caption>" + escaped(caption) + "</caption><thead><tr>";
  for (const std::string& column : columns)
    body_ += "<th scope=\"col\"><button type=\"button\">" + escaped(column) + "</button></th>";
  body_ += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows) {
    body_ += "<tr>";
    for (const Cell& cell : row)
      body_ += (cell.is_number ? "<td data-number=\"" + exact(cell.number) + "\">"
                               : std::string("<td>")) +
               escaped(cell.text) + "</td>";
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void Page::pictures(const std::vector<Picture>& list) {
  body_ += "<div class=\"pictures\">\n";
  for (const Picture& picture : list)
    body_ += "<figure><button type=\"button\" aria-label=\"Larger or smaller\"><img alt=\"" +
             escaped(picture.caption) + "\" src=\"data:image/png;base64," +
             scenes::base64_encode(picture.png) + "\"></button><figcaption>" +
             escaped(picture.caption) + "</figcaption></figure>\n";
  body_ += "</div>\n";
}

std::string Page::text() const {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escaped(title_) + "</title>\n<style>\n" + file_that_ends("page.css") +
         "</style>\n</head>\n<body>\n<h1>" + escaped(title_) + "</h1>\n" + body_ + "<script>\n" +
         file_that_ends("page.js") + "</script>\n</body>\n</html>\n";
}

std::string exact(double value) {
  if (!std::isfinite(value)) return {};
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line += ',';
    if (cells[i].find_first_of(",\"\r\n") == std::string::npos) {
      line += cells[i];
      continue;
    }
    line += '"';
    for (const char c : cells[i]) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line + "\r\n";
}

}  // namespace penumbra::experiments
