#pragma once

#include <map>
#include <string>
#include <vector>

namespace penumbra::experiments {

/// Names tables 4.3 to 4.9 of van Sambeek 2007 where a study is asked for.
inline constexpr auto published_ranks = "published";

/// Mean ranks that people gave techniques, 1 most realistic.
struct Ranks {
  std::map<std::string, double> mean;  ///< by technique or preset, as read_technique takes it
  std::vector<std::string> unknown;    ///< names that this program does not have
  bool of_scene = false;               ///< of the scene that was asked for, not over all
};

/// From results.json of `penumbra statistics`, whose pictures count where their ids are those of
/// techniques or presets, or from `published_ranks`. Ranks are the scene's where
/// people saw it, and those over all scenes otherwise. Throws unreadable and bad_value (field
/// "study").
Ranks perceived_ranks(const std::string& study, const std::string& scene = "");

}  // namespace penumbra::experiments
