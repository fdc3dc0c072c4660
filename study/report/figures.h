#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/measures.h"

namespace penumbra::study {

struct Study;

struct FigureOptions {
  std::map<std::string, std::string> labels;  ///< names of pictures by id; the id where missing
  std::string most_label = "most realistic";
  std::string least_label = "least realistic";
  std::string set = "all";  ///< of the report's included_sets
  double width_mm = 0.0;    ///< 0: the width that suits each kind
  Measures measures;        ///< of the pictures shown; may be empty
};

/// Labels and ends of a study, in its default language.
FigureOptions figure_options(const Study& study);

/// An SVG document and its name: of letters, digits and dashes, unique among those of a report.
struct Figure {
  std::string name;
  std::string title;
  std::string scene;  ///< empty: all scenes
  std::string svg;
};

/// Figures of a document of statistics_report: mean ranks, critical difference, histograms and
/// worths of all scenes and, where there are several, of each; objective measures against perceived
/// realism and the Pareto front where measures are known.
std::vector<Figure> figures_of(const nlohmann::json& report, const FigureOptions& options);

}  // namespace penumbra::study
