#include "experiments/recommend/model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace penumbra::experiments::recommend {
namespace {

/// Errors below this share of `none`'s are exact.
constexpr double exact_share = 1e-3;

struct Ratios {
  double error;
  double ms;
  double bytes;
};

/// Logarithms of what a candidate is to `none`; bytes by themselves, since `none` takes none.
Ratios ratios(const Known& known, const Known& none) {
  return {std::log(std::max(known.error / none.error, exact_share)),
          std::log(std::max(known.ms, 1e-6) / none.ms), std::log(1.0 + known.bytes)};
}

std::string technique_of(const std::string& candidate) {
  return candidate.substr(0, candidate.find(':'));
}

/// Weight of a measured scene by how alike probes came out there.
double weight_of(const MeasuredScene& scene, const Known& none, const Probes& probes,
                 const ModelConstants& constants) {
  double squares = 0.0;
  std::size_t count = 0;
  for (const auto& [name, known] : probes) {
    const auto there = scene.candidates.find(name);
    if (there == scene.candidates.end()) continue;
    const Ratios here = ratios(known, none), then = ratios(there->second, scene.none);
    squares += std::pow(here.error - then.error, 2) + std::pow(here.ms - then.ms, 2);
    ++count;
  }
  if (count == 0) return 1.0;
  const double distance = squares / static_cast<double>(count);
  return std::max(constants.least_weight,
                  std::exp(-0.5 * distance / (constants.likeness * constants.likeness)));
}

struct Mean {
  Ratios value{};
  double error_spread = 0.0;
  double ms_spread = 0.0;
};

std::optional<Mean> mean_over_scenes(const Measured& others, const std::vector<double>& weights,
                                     const std::string& candidate) {
  double sum = 0.0;
  Mean mean;
  std::vector<std::pair<double, Ratios>> seen;
  for (std::size_t i = 0; i < others.scenes.size(); ++i) {
    const auto found = others.scenes[i].candidates.find(candidate);
    if (found == others.scenes[i].candidates.end()) continue;
    seen.emplace_back(weights[i], ratios(found->second, others.scenes[i].none));
    sum += weights[i];
  }
  if (seen.empty()) return std::nullopt;
  for (const auto& [weight, ratio] : seen) {
    mean.value.error += weight / sum * ratio.error;
    mean.value.ms += weight / sum * ratio.ms;
    mean.value.bytes += weight / sum * ratio.bytes;
  }
  for (const auto& [weight, ratio] : seen) {
    mean.error_spread += weight / sum * std::pow(ratio.error - mean.value.error, 2);
    mean.ms_spread += weight / sum * std::pow(ratio.ms - mean.value.ms, 2);
  }
  mean.error_spread = std::sqrt(mean.error_spread);
  mean.ms_spread = std::sqrt(mean.ms_spread);
  return mean;
}

/// Guesses of all candidates that are known of, but those that were probed.
class Model {
 public:
  Model(const Measured& others, const Known& none, const Probes& probes,
        const ModelConstants& constants)
      : others_(others), none_(none), constants_(constants) {
    for (const MeasuredScene& scene : others.scenes)
      weights_.push_back(weight_of(scene, none, probes, constants));
    for (const auto& [name, known] : probes)
      if (const auto mean = mean_over_scenes(others, weights_, name)) {
        const Ratios here = ratios(known, none);
        misses_.push_back({technique_of(name),
                           {here.error - mean->value.error, here.ms - mean->value.ms,
                            here.bytes - mean->value.bytes}});
      }
  }

  std::optional<Guess> guess(const std::string& candidate) const {
    const auto mean = mean_over_scenes(others_, weights_, candidate);
    if (!mean) return std::nullopt;
    const std::string technique = technique_of(candidate);
    Ratios shift{};
    double sum = constants_.prior;
    for (const auto& [of, miss] : misses_) {
      const double weight = of == technique ? constants_.kin : constants_.others;
      shift.error += weight * miss.error;
      shift.ms += weight * miss.ms;
      shift.bytes += weight * miss.bytes;
      sum += weight;
    }
    return Guess{none_.error * std::exp(mean->value.error + shift.error / sum),
                 none_.ms * std::exp(mean->value.ms + shift.ms / sum),
                 std::exp(mean->value.bytes + shift.bytes / sum) - 1.0, mean->error_spread,
                 mean->ms_spread};
  }

 private:
  const Measured& others_;
  Known none_;
  ModelConstants constants_;
  std::vector<double> weights_;
  std::vector<std::pair<std::string, Ratios>> misses_;
};

/// Less error at the budget, or the same error for less time: how much a candidate that was not
/// measured promises over the best of those that were. A logarithm; zero or less: nothing. Errors
/// below `exact` are equal: what is exact can only be had for less time.
double promise(const Guess& guess, const Known* best, bool best_fits, const Budget& budget,
               double exact, const ModelConstants& constants) {
  const double error = guess.error * std::exp(-constants.hope * guess.error_spread);
  const double ms = guess.ms * std::exp(-constants.hope * guess.ms_spread);
  const bool may_fit = budget.holds_ms(ms) && (!budget.bytes || guess.bytes <= 1.1 * *budget.bytes);
  if (best == nullptr) return may_fit ? 100.0 - std::log(guess.error) : -std::log(guess.ms);
  if (!best_fits)
    return may_fit ? 100.0 - std::log(guess.error) : std::log(best->ms) - std::log(ms);
  if (!may_fit) return 0.0;
  const double tie = std::log1p(constants.tie);
  const double gain = std::log(std::max(best->error, exact) / std::max(error, exact));
  if (gain > tie) return gain;
  return gain > -tie ? std::log(best->ms / ms) : 0.0;
}

}  // namespace

std::optional<Guess> guess(const Measured& others, const Known& none, const Probes& probes,
                           const std::string& candidate, const ModelConstants& constants) {
  return Model(others, none, probes, constants).guess(candidate);
}

std::string best_of(const Probes& measured, const Budget& budget, double tie) {
  const auto better = [&](const Known& a, const Known& b) {
    if (budget.holds(a) != budget.holds(b)) return budget.holds(a);
    return budget.holds(a) ? a.error < b.error : a.ms < b.ms;
  };
  const std::pair<const std::string, Known>* best = nullptr;
  for (const auto& entry : measured)
    if (best == nullptr || better(entry.second, best->second)) best = &entry;
  if (best == nullptr) return {};
  if (!budget.holds(best->second)) return best->first;
  const double bound = best->second.error * (1.0 + tie);
  for (const auto& entry : measured)
    if (budget.holds(entry.second) && entry.second.error <= bound &&
        entry.second.ms < best->second.ms)
      best = &entry;
  return best->first;
}

namespace {

/// What to try next: what promises most over `best`, or, where nothing promises more, what has the
/// least error of all that should be faster. Empty: neither is there.
std::string next_trial(const Model& model, const std::vector<std::string>& candidates,
                       const std::set<std::string>& tried, const Known& none, const Known* best,
                       const Budget& budget, const ModelConstants& constants) {
  const bool fits = best != nullptr && budget.holds(*best);
  const double exact = std::max(exact_share * none.error, 1e-12);
  std::string promising, faster;
  double most = 0.0, least = std::numeric_limits<double>::infinity();
  for (const std::string& candidate : candidates) {
    if (tried.contains(candidate)) continue;
    const auto expected = model.guess(candidate);
    if (!expected) continue;
    const double gain = promise(*expected, best, fits, budget, exact, constants);
    if (gain > most || (promising.empty() && best == nullptr)) {
      most = gain;
      promising = candidate;
    }
    if (fits && expected->ms < best->ms && expected->error < least) {
      least = expected->error;
      faster = candidate;
    }
  }
  return promising.empty() ? faster : promising;
}

}  // namespace

Choice choose(const Measured& others, const std::vector<std::string>& candidates, const Known& none,
              const Budget& budget,
              const std::function<std::optional<Known>(const std::string&)>& measure,
              const ModelConstants& constants) {
  Choice choice;
  Probes probes;
  std::set<std::string> tried;
  while (tried.size() < most_probes) {
    const std::string best = best_of(probes, budget, constants.tie);
    const Known* known = best.empty() ? nullptr : &probes.at(best);
    const std::string next = next_trial(Model(others, none, probes, constants), candidates, tried,
                                        none, known, budget, constants);
    if (next.empty()) break;
    tried.insert(next);
    if (const auto result = measure(next)) {
      probes[next] = *result;
      choice.probed.push_back(next);
    }
  }
  choice.candidate = best_of(probes, budget, constants.tie);
  choice.fits = !choice.candidate.empty() && budget.holds(probes.at(choice.candidate));
  return choice;
}

}  // namespace penumbra::experiments::recommend
