#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/stability/axes.h"
#include "experiments/stability/judge.h"

/// From gentle to absurd until something breaks: pure functions over what a step gave.
namespace penumbra::experiments::stability {

/// What came of one step.
enum class State {
  drawn,
  refused,  ///< an error that names what is at fault
  opaque,   ///< an error that does not
  crashed,  ///< the process that drew it died
  hung      ///< it was ended, since nothing came
};

struct Step {
  double value = 0.0;
  State state = State::drawn;
  Verdict verdict;                   ///< of what was drawn
  std::vector<std::string> notes;    ///< the renderer's
  std::string code, field, message;  ///< of an error; the signal's name of a crash
  double seconds = 0.0;              ///< wall time of drawing, judging left out
};

nlohmann::json to_json(const Step& step);
Step step_from_json(const nlohmann::json& row);

/// Broken beside the gentle step: visibility_rms over twice its and over 0.02, light lost on more
/// than twice its share and over 2% of the lit pixels, a value that is no number, or no picture and
/// no typed error either.
bool is_broken(const Step& gentle, const Step& step);

/// How far one technique goes along one axis.
struct Finding {
  std::string technique;
  std::string axis;
  std::vector<Step> steps;      ///< in the order of values, those between found by halving included
  std::optional<double> holds;  ///< the last value that does; empty where not even the gentle one
  std::optional<double> ends;   ///< the first that breaks or is refused; empty: all hold
  bool refused = false;         ///< `ends` gave a typed error
  std::string cause;            ///< what happens there, in words
  std::string guard;            ///< what the program says there: note, error, magenta, or nothing

  const Step& at(double value) const;
};

/// Calls `draw` for the axis's values in turn, then halves the interval of the first break a few
/// times. The gentle step is broken only where it gives no picture, or numbers that are none.
Finding search(const std::string& technique, const Axis& axis,
               const std::function<Step(double)>& draw);

}  // namespace penumbra::experiments::stability
