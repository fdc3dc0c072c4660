#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "renderer/parameters.h"

/// A search over a technique's parameters for what error it buys for how much time.
///
/// A full grid of eight parameters is out of reach. The search starts from the defaults, takes
/// every single step from them, and then goes on from points that none beats in time and in some
/// error, the one with the fewest steps taken first, with those parameters alone whose steps have
/// led to such points. It ends with the budget, or when no step is left. Parameters that ablate
/// keep their defaults: a method without what it needs is no offer.
namespace penumbra::experiments {

/// What a measurement says: smaller is better everywhere.
struct Scores {
  double time = 0.0;
  std::vector<double> errors;  ///< one an objective
};

struct Found {
  ParameterValues given;         ///< what differs from the defaults
  std::optional<Scores> scores;  ///< empty: refused
};

/// Values one step away: the other choices; twice and half of numbers, where the range allows it,
/// and from
/// zero a sixteenth of a linear range, 1 at most, or the least of a logarithmic one.
std::vector<ParameterValue> steps_from(const Parameter& parameter, const ParameterValue& value);

/// Indices of `found` that none beats both in time and in the error of that objective.
std::vector<std::size_t> front_of(const std::vector<Found>& found, std::size_t objective);

/// Measures at most `budget` points, the defaults first; each only once.
std::vector<Found> search(
    const std::vector<Parameter>& parameters, std::size_t budget,
    const std::function<std::optional<Scores>(const ParameterValues&)>& measure);

}  // namespace penumbra::experiments
