#include "experiments/stability/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace penumbra::experiments::stability {
namespace {

/// Below this a change of visibility_rms, or a share of lit pixels that lost their light, says
/// nothing.
constexpr double least_error = 0.02;
/// By how much errors may grow beside the gentle step.
constexpr double growth = 2.0;
/// Halvings of the interval in which something breaks.
constexpr int halvings = 3;

constexpr std::array<std::pair<State, const char*>, 5> state_names{{{State::drawn, "drawn"},
                                                                    {State::refused, "refused"},
                                                                    {State::opaque, "opaque"},
                                                                    {State::crashed, "crashed"},
                                                                    {State::hung, "hung"}}};

const char* name_of(State state) {
  return std::find_if(state_names.begin(), state_names.end(),
                      [&](const auto& entry) { return entry.first == state; })
      ->second;
}

State state_of(const std::string& name) {
  for (const auto& [state, known] : state_names)
    if (name == known) return state;
  throw std::invalid_argument("no state of a step: " + name);
}

std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof(text), "%.2g%%", 100.0 * share);
  return text;
}

std::string cause_of(const Step& gentle, const Step& step) {
  switch (step.state) {
    case State::refused:
      return "refused: " + step.message;
    case State::opaque:
      return "an error that names nothing: " + step.message;
    case State::crashed:
      return "the process died: " + step.message;
    case State::hung:
      return "no end: " + step.message;
    case State::drawn:
      break;
  }
  const Verdict& v = step.verdict;
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (v.non_finite > 0) add(std::to_string(v.non_finite) + " pixels are no numbers");
  if (v.dark_share() > std::max(least_error, growth * gentle.verdict.dark_share()))
    add("the light went out on " + percent(v.dark_share()) + " of the lit pixels");
  const bool leaks = v.missing_shadow > v.false_shadow;
  const std::uint32_t of = leaks ? v.shadowed : v.judged - v.shadowed;
  if (v.visibility_rms > std::max(least_error, growth * gentle.verdict.visibility_rms) && of > 0)
    add(leaks ? "light on " + percent(std::min(1.0, v.missing_shadow / of)) + " of the shadow"
              : "shadow on " + percent(std::min(1.0, v.false_shadow / of)) + " of what is lit");
  return text;
}

std::string guard_of(const Step& gentle, const Step& step) {
  if (step.state == State::refused)
    return "error " + step.code + (step.field.empty() ? "" : ", field " + step.field);
  if (step.state != State::drawn) return "none";
  std::string text;
  for (const std::string& note : step.notes)
    if (std::find(gentle.notes.begin(), gentle.notes.end(), note) == gentle.notes.end())
      text += (text.empty() ? "note: " : "; ") + note;
  if (step.verdict.non_finite > 0)
    text += std::string(text.empty() ? "" : "; ") + "magenta, counted";
  return text.empty() ? "none" : text;
}

double between(const Axis& axis, double a, double b) {
  const double middle = a > 0.0 && b > 0.0 ? std::sqrt(a * b) : 0.5 * (a + b);
  return axis.whole ? std::round(middle) : middle;
}

bool ends_axis(const Step& gentle, const Step& step) {
  return step.state != State::drawn || is_broken(gentle, step);
}

}  // namespace

nlohmann::json to_json(const Step& step) {
  const Verdict& v = step.verdict;
  return {{"value", step.value},
          {"state", name_of(step.state)},
          {"judged", v.judged},
          {"shadowed", v.shadowed},
          {"visibility_rms", v.visibility_rms},
          {"false_shadow", v.false_shadow},
          {"missing_shadow", v.missing_shadow},
          {"lit", v.lit},
          {"dark", v.dark},
          {"non_finite", v.non_finite},
          {"notes", step.notes},
          {"code", step.code},
          {"field", step.field},
          {"message", step.message},
          {"seconds", step.seconds}};
}

Step step_from_json(const nlohmann::json& row) {
  Step step;
  step.value = row.at("value");
  step.state = state_of(row.at("state"));
  Verdict& v = step.verdict;
  v.judged = row.at("judged");
  v.shadowed = row.at("shadowed");
  v.visibility_rms = row.at("visibility_rms");
  v.false_shadow = row.at("false_shadow");
  v.missing_shadow = row.at("missing_shadow");
  v.lit = row.at("lit");
  v.dark = row.at("dark");
  v.non_finite = row.at("non_finite");
  step.notes = row.at("notes").get<std::vector<std::string>>();
  step.code = row.at("code");
  step.field = row.at("field");
  step.message = row.at("message");
  step.seconds = row.at("seconds");
  return step;
}

bool is_broken(const Step& gentle, const Step& step) {
  if (step.state == State::refused) return false;
  if (step.state != State::drawn || step.verdict.non_finite > 0) return true;
  const Verdict& g = gentle.verdict;
  const Verdict& v = step.verdict;
  return v.visibility_rms > std::max(least_error, growth * g.visibility_rms) ||
         v.dark_share() > std::max(least_error, growth * g.dark_share());
}

const Step& Finding::at(double value) const {
  for (const Step& step : steps)
    if (step.value == value) return step;
  throw std::logic_error("no step of that value");
}

Finding search(const std::string& technique, const Axis& axis,
               const std::function<Step(double)>& draw) {
  Finding finding;
  finding.technique = technique;
  finding.axis = axis.id;
  const auto end_at = [&](const Step& step) {
    const Step& gentle = finding.steps.front();
    finding.ends = step.value;
    finding.refused = step.state == State::refused;
    finding.cause = cause_of(gentle, step);
    finding.guard = guard_of(gentle, step);
  };
  finding.steps.push_back(draw(axis.values.front()));
  const Step gentle = finding.steps.front();
  if (gentle.state != State::drawn || gentle.verdict.non_finite > 0) {
    end_at(gentle);
    return finding;
  }
  finding.holds = gentle.value;
  for (std::size_t i = 1; i < axis.values.size() && !finding.ends; ++i) {
    const Step step = draw(axis.values[i]);
    finding.steps.push_back(step);
    if (ends_axis(gentle, step)) {
      end_at(step);
    } else {
      finding.holds = step.value;
    }
  }
  for (int i = 0; finding.ends && axis.has_between() && i < halvings; ++i) {
    const double middle = between(axis, *finding.holds, *finding.ends);
    if (middle == *finding.holds || middle == *finding.ends) break;
    const Step step = draw(middle);
    finding.steps.push_back(step);
    if (ends_axis(gentle, step)) {
      end_at(step);
    } else {
      finding.holds = middle;
    }
  }
  return finding;
}

}  // namespace penumbra::experiments::stability
