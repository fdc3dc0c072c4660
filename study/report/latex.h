#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace penumbra::study {

/// Text for LaTeX: its special characters escaped, line ends as blanks. Letters that pdflatex does
/// not know without further packages (beyond Latin-1) become their number, [U+771F].
std::string latex_text(std::string_view text);

/// Tables of a document of statistics_report for \input: means, intervals and letters of all scenes
/// and of each scene, and the tests of all pairs of all scenes. They need the package booktabs.
std::string latex_tables(const nlohmann::json& report,
                         const std::map<std::string, std::string>& labels);

}  // namespace penumbra::study
