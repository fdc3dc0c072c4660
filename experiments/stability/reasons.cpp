#include <nlohmann/json.hpp>

#include "experiments/stability/report.h"
#include "renderer/embedded_file.h"

namespace penumbra::experiments::stability {

std::span<const EmbeddedFile> embedded_reasons();

namespace {

bool fits(const std::string& pattern, const std::string& name) {
  if (pattern.ends_with('*')) return name.starts_with(pattern.substr(0, pattern.size() - 1));
  return pattern == name;
}

}  // namespace

const std::vector<Reason>& reasons() {
  static const std::vector<Reason> list = [] {
    std::vector<Reason> read;
    for (const auto& row : nlohmann::json::parse(embedded_reasons().front().text))
      for (const auto& technique : row.at("techniques"))
        for (const auto& axis : row.at("axes"))
          read.push_back({technique, axis, row.at("required"), row.at("why")});
    return read;
  }();
  return list;
}

const Reason* reason_of(const std::string& technique, const std::string& axis) {
  for (const Reason& reason : reasons())
    if (fits(reason.technique, technique) && fits(reason.axis, axis)) return &reason;
  return nullptr;
}

}  // namespace penumbra::experiments::stability
