#pragma once

#include <string>
#include <utility>
#include <vector>

/// Pages of reports: one file that opens offline, with tables that sort by a click on a heading.
namespace penumbra::experiments::html {

struct Cell {
  std::string text;
  double number = 0.0;  ///< what the column sorts by, where its texts are numbers with units
  bool is_number() const { return number != 0.0; }
};

class Page {
 public:
  explicit Page(const std::string& title);

  void heading(const std::string& text);
  void paragraph(const std::string& text);
  void facts(const std::vector<std::pair<std::string, std::string>>& list);
  void figure(const std::string& svg);
  void table(const std::vector<std::string>& columns, const std::vector<std::vector<Cell>>& rows);

  std::string text() const;

 private:
  std::string title_;
  std::string body_;
};

}  // namespace penumbra::experiments::html
