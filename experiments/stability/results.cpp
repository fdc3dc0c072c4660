#include "experiments/stability/results.h"

#include <fstream>

#include "renderer/error.h"

namespace penumbra::experiments::stability {

Results::Results(const std::filesystem::path& file) : file_(file) {
  std::ifstream in(file);
  std::uintmax_t whole = 0;
  for (std::string line; std::getline(in, line) && !in.eof();) {
    const auto row = nlohmann::json::parse(line, nullptr, false);
    if (row.is_discarded() || !row.contains("key")) break;
    rows_[row.at("key")] = row.at("result");
    whole += line.size() + 1;
  }
  in.close();
  std::error_code failed;
  if (std::filesystem::exists(file)) std::filesystem::resize_file(file, whole, failed);
  if (failed || !std::ofstream(file, std::ios::app))
    throw Error("unwritable", "cannot write " + file.string() + ": " + failed.message(), "out");
}

const nlohmann::json* Results::find(const std::string& key) const {
  const auto row = rows_.find(key);
  return row == rows_.end() ? nullptr : &row->second;
}

void Results::add(const std::string& key, const nlohmann::json& result) {
  std::ofstream out(file_, std::ios::app);
  out << nlohmann::json{{"key", key}, {"result", result}}.dump(
             -1, ' ', false, nlohmann::json::error_handler_t::replace)
      << '\n';
  out.flush();
  if (!out) throw Error("unwritable", "cannot write " + file_.string(), "out");
  rows_[key] = result;
}

}  // namespace penumbra::experiments::stability
