#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/enrolment.h"
#include "study/random.h"
#include "study/responses.h"
#include "study/study.h"

namespace penumbra::study {

enum class PersonKind { honest, inverted, random };

/// Known preferences: Plackett-Luce with ties (Davidson-Luce, Turner et al. 2020): at each step a
/// set of t of the pictures left is put on the next shelf with probability proportional to tie[t] *
/// (product of its worths)^(1/t).
struct Preferences {
  std::map<std::string, double> log_worths;  ///< by picture id; missing ones are 0
  double tie_of_two = 0.2;  ///< prevalence of ties of two relative to single pictures; 0: none
  double tie_of_three = 0.02;
};

/// Preferences in the order of the study's pictures on its first page: the first has the lowest
/// worth and log worths step by `step`.
Preferences default_preferences(const Study& study, double step = 0.5);

/// One page of such a person: the shelf of each picture, 0 first chosen.
std::vector<int> draw_shelves(const std::vector<double>& log_worths, const Preferences& preferences,
                              Random& random);

struct SimulatedPerson {
  PersonKind kind = PersonKind::honest;
  std::uint64_t seed = 0;
};

/// `participants` people, `inverted` of them with the scale backwards and `random` without any
/// preference, mixed. Throws bad_value where those are more than there are people.
std::vector<SimulatedPerson> simulate_people(std::size_t participants, std::size_t inverted,
                                             std::size_t random, std::uint64_t seed);

/// The body of PUT .../pages/{page} for position `page_index` of a person's plan. The same
/// arguments give the same answer, its answer_id included.
nlohmann::json simulate_answer(const Study& study, const SimulatedPerson& person,
                               const EnrolmentPlan& plan, std::size_t page_index,
                               const Preferences& preferences);

/// A whole study at once without a server: the rows that its export would hold (practice left out).
std::vector<ResponseRow> simulate_responses(const Study& study,
                                            const std::vector<SimulatedPerson>& people,
                                            const Preferences& preferences, std::uint64_t seed);

}  // namespace penumbra::study
