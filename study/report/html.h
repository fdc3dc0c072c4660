#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/report/figures.h"

namespace penumbra::study {

struct Study;

/// Who took part, as only the server knows.
struct Attendance {
  std::size_t entered = 0;  ///< without previews
  std::size_t completed = 0;
  std::size_t withdrawn = 0;  ///< deleted themselves with all answers
  struct Exclusion {
    std::string participant;
    std::string reason;
  };
  std::vector<Exclusion> excluded;  ///< by researchers
};

struct ReportContext {
  const Study* study = nullptr;  ///< not known where only a CSV was analysed
  std::optional<Attendance> attendance;
  FigureOptions figures;
};

/// The results of a document of statistics_report in words, tables and figures: one HTML file
/// without scripts, links or other files, readable on dark and light screens and on paper.
std::string html_report(const nlohmann::json& report, const ReportContext& context);

}  // namespace penumbra::study
