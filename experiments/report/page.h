#pragma once

#include <string>
#include <utility>
#include <vector>

/// Pages of reports: one HTML file that opens offline, with tables that sort by a click on a
/// heading and pictures that grow by a click on them.
namespace penumbra::experiments {

struct Cell {
  Cell(std::string text_) : text(std::move(text_)) {}
  Cell(const char* text_) : text(text_) {}
  /// A number with so many decimals; sorted by its value. Not finite: a dash.
  Cell(double value, int decimals);

  std::string text;
  bool is_number = false;
  double number = 0.0;
};

class Page {
 public:
  explicit Page(std::string title) : title_(std::move(title)) {}

  void heading(const std::string& text);
  void paragraph(const std::string& text);
  /// Names and what they have, below each other.
  void facts(const std::vector<std::pair<std::string, std::string>>& list);
  void figure(const std::string& svg, const std::string& caption);
  void table(const std::string& caption, const std::vector<std::string>& columns,
             const std::vector<std::vector<Cell>>& rows);
  struct Picture {
    std::string png;  ///< bytes
    std::string caption;
  };
  void pictures(const std::vector<Picture>& list);

  std::string text() const;

 private:
  std::string title_;
  std::string body_;
};

/// Lines of CSV (RFC 4180) from cells of text.
std::string csv_line(const std::vector<std::string>& cells);

/// The shortest text that reads back as the same number; empty where it is none.
std::string exact(double value);

}  // namespace penumbra::experiments
