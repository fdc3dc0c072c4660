#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/answer.h"
#include "study/enrolment.h"
#include "study/study.h"

/// What a study checks beside the ranks: attention and gold items, the practice page, the screen's
/// brightness, entries under one name.
namespace penumbra::study {

/// A flag for another reason than the ranks, which the checks give.
struct GivenFlag {
  std::string participant;
  std::string name;
  double value = 0.0;
  double threshold = 0.0;
  std::string reason;
};

/// An answered page that has an expected answer.
struct CheckedPage {
  std::string page;  ///< id, with ".again" for its second showing
  bool attention = false;
  bool met = false;
};

struct PersonChecks {
  std::vector<CheckedPage> pages;
  std::optional<bool> practice_right;  ///< empty where there was no practice page, or no answer yet
  std::optional<int> patches_seen;
  int entries = 1;  ///< of this person's name in the study

  int failures() const;
};

/// Columns of participants.csv that pages with an expected answer have: their names as in
/// CheckedPage.
std::vector<std::string> checked_pages(const Study& study);

/// Whether an answer is the one expected of the page. `order` has a number per slot, the lowest is
/// most realistic.
bool meets(const Expectation& expected, const Page& page, const PlannedPage& planned,
           const std::vector<int>& order);

/// True where no two pictures of the practice page are the wrong way round, and its best one
/// is before its worst.
bool practice_is_right(const PlannedPage& planned, const std::vector<int>& order);

/// Checks of one person. `answers` are bodies as they were sent, by position in the plan; `details`
/// what was told about the person.
PersonChecks checks_of(const Study& study, const EnrolmentPlan& plan,
                       const std::vector<std::pair<std::size_t, nlohmann::json>>& answers,
                       const nlohmann::json& details);

/// Whether the study is over for a person since a check failed.
bool is_screened_out(const Study& study, const PersonChecks& checks);

/// Whether any check can end the study for a person.
bool can_screen_out(const Study& study);

/// Failed checks as flags: attention, gold, dim_screen, several_entries.
std::vector<GivenFlag> check_flags(const Study& study, const std::string& participant,
                                   const PersonChecks& checks);

}  // namespace penumbra::study
