#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace penumbra::server::cli {

/// Columns for people; the first is flush left, the others flush right.
class Table {
 public:
  explicit Table(std::vector<std::string> header) { rows_.push_back(std::move(header)); }
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  std::string text(bool all_left = false) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// A number with so many decimals; "-" for null.
std::string number(const nlohmann::json& value, int decimals);

}  // namespace penumbra::server::cli
