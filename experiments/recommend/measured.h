#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

/// Which technique, with which parameters, for a scene and a budget.
namespace penumbra::experiments::recommend {

/// What a candidate does on a scene.
struct Known {
  double error = 0.0;  ///< against the reference; smaller is better
  double ms = 0.0;     ///< of a frame
  double bytes = 0.0;  ///< over `none`
};

/// A scene at one size. Candidates are named ID[:NAME=VALUE]..., parameters by name; what is
/// missing was not measured, or refused.
struct MeasuredScene {
  std::string scene;
  int size = 0;  ///< pixels along an edge
  Known none;    ///< without shadows
  std::map<std::string, Known> candidates;
};

/// Results of earlier experiments.
struct Measured {
  std::vector<MeasuredScene> scenes;

  /// All candidates that any scene has, by name.
  std::vector<std::string> candidates() const;
};

/// A technique's id or preset with what is given to it: a candidate's name.
std::string candidate_name(const std::string& id, const nlohmann::json& given);

/// Adds rows of results.csv as sweep and tradeoff write them; `error` is the column that is judged.
/// Scenes that have no row of `none`, and rows that failed or were not judged, are left out. Throws
/// unreadable (field "from") where a column is missing or a cell is no number.
void add_results(Measured& measured, std::string_view csv, const std::string& error);

/// What this program brings along, measured on a processor or on a GPU.
Measured measured_before(bool gpu, const std::string& error);

}  // namespace penumbra::experiments::recommend
