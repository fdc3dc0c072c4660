#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/recommend/measured.h"

/// The model: a candidate's error and time are those of `none` times a ratio. Before anything of a
/// scene is known, a ratio's logarithm is the mean over the measured scenes. Every probe then tells
/// twice: scenes on which probes came out alike weigh more, and what a probe missed by is added to
/// other candidates, more to those of the same technique.
namespace penumbra::experiments::recommend {

/// Constants of the model, in logarithms of ratios.
struct ModelConstants {
  double likeness = 0.35;      ///< scenes whose probes differ by this weigh exp(-1/2) ...
  double least_weight = 0.02;  ///< ... and none less than this
  double kin = 1.0;            ///< weight of a probe's miss for the same technique ...
  double others = 0.25;        ///< ... and for others ...
  double prior = 0.5;          ///< ... against this weight of no miss at all
  double hope = 1.0;           ///< standard deviations granted to what was not measured
  double tie = 0.02;           ///< errors this close count as equal: the faster one is taken
};

struct Guess {
  double error = 0.0;
  double ms = 0.0;
  double bytes = 0.0;
  double error_spread = 0.0;  ///< standard deviation of the error's logarithm over scenes
  double ms_spread = 0.0;
};

using Probes = std::map<std::string, Known>;

/// What to expect of a candidate; nothing where no measured scene has it.
std::optional<Guess> guess(const Measured& others, const Known& none, const Probes& probes,
                           const std::string& candidate, const ModelConstants& constants = {});

/// What a frame may take.
struct Budget {
  double ms = 0.0;
  std::optional<double> bytes;
  /// Guesses go through logarithms: what those round is no excess.
  bool holds_ms(double value) const { return value <= ms * (1.0 + 1e-9); }
  bool holds(const Known& known) const {
    return holds_ms(known.ms) && (!bytes || known.bytes <= *bytes);
  }
};

/// Most runs of the scene itself, beside `none`.
constexpr std::size_t most_probes = 10;

struct Choice {
  std::string candidate;            ///< empty: nothing could be drawn
  bool fits = false;                ///< the budget; otherwise it is the fastest that was tried
  std::vector<std::string> probed;  ///< in order
};

/// Tries candidates on the scene, the one that promises most first. Where none promises more than
/// what was measured, those that should be faster than the best follow, the nearest to the truth
/// first, until there are none or `most_probes` are tried. `measure` returns nothing for a
/// candidate that is refused. The choice is the least error that fits the budget, the faster of
/// those that tie.
Choice choose(const Measured& others, const std::vector<std::string>& candidates, const Known& none,
              const Budget& budget,
              const std::function<std::optional<Known>(const std::string&)>& measure,
              const ModelConstants& constants = {});

/// The best of what was measured by the same rule.
std::string best_of(const Probes& measured, const Budget& budget, double tie);

}  // namespace penumbra::experiments::recommend
