#include "experiments/tradeoff/search.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <set>

namespace penumbra::experiments {
namespace {

constexpr double first_share = 1.0 / 16.0;  ///< of a linear range, away from zero ...
constexpr double first_step = 1.0;          ///< ... at most: ranges in metres are wide

std::optional<ParameterValue> number_in_range(const Parameter& parameter, double value) {
  if (!(value >= parameter.minimum && value <= parameter.maximum)) return std::nullopt;
  if (parameter.type == ParameterType::integer)
    return static_cast<std::int64_t>(std::llround(value));
  return value;
}

/// The search's memory of one technique.
class Walk {
 public:
  Walk(const std::vector<Parameter>& parameters, std::size_t budget,
       const std::function<std::optional<Scores>(const ParameterValues&)>& measure)
      : parameters_(parameters), budget_(budget), measure_(measure) {}

  std::vector<Found> run() {
    visit({});
    if (found_.empty() || !found_.front().scores) return std::move(found_);
    take_steps(0, {});
    std::set<std::size_t> expanded{0};
    while (found_.size() < budget_) {
      const auto next = best_unexpanded(expanded);
      if (!next) break;
      expanded.insert(*next);
      take_steps(*next, useful());
    }
    return std::move(found_);
  }

 private:
  void visit(const ParameterValues& given) {
    if (found_.size() >= budget_ || !seen_.insert(given).second) return;
    found_.push_back({given, measure_(given)});
  }

  /// Every step from a point, over the parameters of `names`, or all where it is empty.
  void take_steps(std::size_t from, const std::set<std::string>& names) {
    const ParameterValues origin = found_[from].given;
    for (const Parameter& parameter : parameters_) {
      if (!names.empty() && !names.contains(parameter.name)) continue;
      if (parameter.ablates || !has_effect(parameter, parameters_, origin)) continue;
      const auto now = origin.find(parameter.name);
      const ParameterValue value = now == origin.end() ? parameter.default_value : now->second;
      for (const ParameterValue& step : steps_from(parameter, value)) {
        ParameterValues next = origin;
        if (step == parameter.default_value)
          next.erase(parameter.name);
        else
          next[parameter.name] = step;
        visit(next);
      }
    }
  }

  std::set<std::size_t> on_fronts() const {
    std::set<std::size_t> all;
    for (std::size_t k = 0; k < found_.front().scores->errors.size(); ++k)
      for (const std::size_t index : front_of(found_, k)) all.insert(index);
    return all;
  }

  std::optional<std::size_t> best_unexpanded(const std::set<std::size_t>& expanded) const {
    std::optional<std::size_t> best;
    for (const std::size_t index : on_fronts())
      if (!expanded.contains(index) &&
          (!best || found_[index].given.size() < found_[*best].given.size()))
        best = index;
    return best;
  }

  std::set<std::string> useful() const {
    std::set<std::string> names;
    for (const std::size_t index : on_fronts())
      for (const auto& [name, value] : found_[index].given) names.insert(name);
    return names;
  }

  const std::vector<Parameter>& parameters_;
  std::size_t budget_;
  const std::function<std::optional<Scores>(const ParameterValues&)>& measure_;
  std::vector<Found> found_;
  std::set<ParameterValues> seen_;
};

}  // namespace

std::vector<ParameterValue> steps_from(const Parameter& parameter, const ParameterValue& value) {
  std::vector<ParameterValue> steps;
  if (parameter.type == ParameterType::boolean) {
    steps.emplace_back(!std::get<bool>(value));
  } else if (parameter.type == ParameterType::choice) {
    for (const std::string& choice : parameter.choices)
      if (choice != std::get<std::string>(value)) steps.emplace_back(choice);
  } else {
    const double now = parameter.type == ParameterType::integer
                           ? static_cast<double>(std::get<std::int64_t>(value))
                           : std::get<double>(value);
    const double zero_step =
        parameter.scale == ParameterScale::logarithmic
            ? parameter.minimum
            : std::min(first_step, first_share * (parameter.maximum - parameter.minimum));
    const std::vector<double> nexts =
        now == 0.0 ? std::vector<double>{zero_step} : std::vector<double>{2.0 * now, 0.5 * now};
    for (const double next : nexts)
      if (const auto step = number_in_range(parameter, next); step && *step != value)
        steps.push_back(*step);
  }
  return steps;
}

std::vector<std::size_t> front_of(const std::vector<Found>& found, std::size_t objective) {
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i].scores) continue;
    const Scores& mine = *found[i].scores;
    const bool beaten = std::any_of(found.begin(), found.end(), [&](const Found& other) {
      return other.scores && other.scores->time <= mine.time &&
             other.scores->errors[objective] <= mine.errors[objective] &&
             (other.scores->time < mine.time ||
              other.scores->errors[objective] < mine.errors[objective]);
    });
    if (!beaten) front.push_back(i);
  }
  return front;
}

std::vector<Found> search(
    const std::vector<Parameter>& parameters, std::size_t budget,
    const std::function<std::optional<Scores>(const ParameterValues&)>& measure) {
  return Walk(parameters, budget, measure).run();
}

}  // namespace penumbra::experiments
