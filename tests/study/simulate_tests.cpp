#include "study/simulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "study/statistics/report.h"
#include "study_file.h"

namespace penumbra::study {
namespace {

using nlohmann::json;

/// The thesis study with the nine pictures of van Sambeek 2007, 4.1.2.
Study nine_pictures() {
  json document = thesis_document();
  document["techniques"] = {"shadow-map", "shadow-volumes",   "pcf-bilinear", "pcf-3x3",
                            "pcss",       "pcf-bilinear-3x3", "reference",    "soft-shadow-volumes",
                            "vsm-2007"};
  return parse_study(document);
}

TEST(Simulation, TheKnownOrderComesOutAgain) {
  const Study study = nine_pictures();
  const Preferences preferences = default_preferences(study, 0.8);
  const auto rows = simulate_responses(study, simulate_people(100, 0, 0, 1), preferences, 1);
  const json report = statistics_report(rows, report_options(study));
  const json& techniques = report["included_sets"]["all"]["overall"]["techniques"];
  // The study's last picture has the highest worth.
  const auto& pictures = study.pages.front().pictures;
  ASSERT_EQ(techniques.size(), pictures.size());
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    EXPECT_EQ(techniques[i]["technique"], pictures[pictures.size() - 1 - i].id);
  }
}

TEST(Simulation, FirstPlacesFollowTheChoiceModel) {
  // Luce's choice axiom without ties: P(a first) = worth(a) / sum of worths.
  Study study = nine_pictures();
  Preferences preferences = default_preferences(study, 0.4);
  preferences.tie_of_two = 0.0;
  preferences.tie_of_three = 0.0;
  const auto rows = simulate_responses(study, simulate_people(500, 0, 0, 5), preferences, 5);
  std::map<std::string, double> firsts;
  for (const ResponseRow& row : rows) firsts[row.technique] += row.rank == 1.0 ? 1.0 : 0.0;
  double total = 0.0;
  for (const auto& [id, worth] : preferences.log_worths) total += std::exp(worth);
  for (const auto& [id, worth] : preferences.log_worths) {
    const double expected = std::exp(worth) / total;
    const double error = std::sqrt(expected * (1.0 - expected) / 3000.0);
    EXPECT_NEAR(firsts[id] / 3000.0, expected, 4.5 * error) << id;
  }
}

struct Caught {
  double inverted = 0.0;  ///< share of inverted people who are flagged
  double honest = 0.0;    ///< share of honest people who are
};

constexpr std::size_t who_told = 6;  // that they had read the scale backwards, of 61 (2007, 6.3)

/// `inverted` of 61 read the scale backwards and three rank at random, over `seeds` studies.
Caught catch_inverted(double step, std::uint64_t seeds, std::size_t inverted = who_told) {
  const Study study = nine_pictures();
  const Preferences preferences = default_preferences(study, step);
  Caught caught;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const auto people = simulate_people(61, inverted, 3, seed);
    const auto rows = simulate_responses(study, people, preferences, seed);
    std::set<std::string> flagged;
    for (const json& flag : screening_flags(statistics::gather(rows), study.analysis.screening)) {
      if (flag["flag"] == "inverted") flagged.insert(flag["participant"].get<std::string>());
    }
    for (std::size_t i = 0; i < people.size(); ++i) {
      const std::string number = std::to_string(i + 1);
      if (!flagged.contains("S" + std::string(6 - number.size(), '0') + number)) continue;
      if (people[i].kind == PersonKind::random) continue;
      (people[i].kind == PersonKind::inverted ? caught.inverted : caught.honest) += 1.0;
    }
  }
  const auto of_all = [&](double found, std::size_t people) {
    return found / static_cast<double>(people * seeds);
  };
  return {of_all(caught.inverted, inverted), of_all(caught.honest, 58 - inverted)};
}

TEST(Simulation, InvertedPeopleAreFlaggedAndHonestOnesAreNotWherePreferencesAreClear) {
  // Claim P03: log worths 0.8 apart, so that 69 in 100 prefer the better of two neighbours.
  const Caught caught = catch_inverted(0.8, 200);
  RecordProperty("inverted_flagged", std::to_string(caught.inverted));
  RecordProperty("honest_flagged", std::to_string(caught.honest));
  EXPECT_GE(caught.inverted, 0.95);
  EXPECT_LE(caught.honest, 0.01);
}

TEST(Simulation, InvertedPeopleAreFlaggedWhereOthersDidNotTellThatTheyWereToo) {
  // Claim P03 with k more who turned the scale round: they pull everybody else's mean towards the
  // middle, and lean on each other. 61 people hold twice as many as told of it.
  for (const std::size_t k : {3u, 6u}) {
    const Caught caught = catch_inverted(0.8, 40, who_told + k);
    EXPECT_GE(caught.inverted, 0.95) << k;
    EXPECT_LE(caught.honest, 0.01) << k;
  }
}

TEST(Simulation, WeakerPreferencesHideInvertedPeopleButAccuseNobody) {
  // Log worths half a step apart: single pages are noisy, and a mean correlation of -0.5 is reached
  // by most of those who turned the scale round, not by all.
  const Caught caught = catch_inverted(0.5, 10);
  EXPECT_GE(caught.inverted, 0.7);
  EXPECT_LT(caught.inverted, 0.95);
  EXPECT_LE(caught.honest, 0.01);
}

TEST(Simulation, PeopleWithoutPreferenceAreMostlyUnreliable) {
  const Study study = nine_pictures();
  const auto people = simulate_people(60, 0, 10, 3);
  const auto rows = simulate_responses(study, people, default_preferences(study), 3);
  std::set<std::string> flagged;
  for (const json& flag : screening_flags(statistics::gather(rows), study.analysis.screening)) {
    if (flag["flag"] == "unreliable") flagged.insert(flag["participant"].get<std::string>());
  }
  int random = 0;
  int honest = 0;
  for (std::size_t i = 0; i < people.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    const bool found = flagged.contains("S" + std::string(6 - number.size(), '0') + number);
    (people[i].kind == PersonKind::random ? random : honest) += found ? 1 : 0;
  }
  EXPECT_GE(random, 7);
  EXPECT_LE(honest, 2);
}

TEST(Simulation, AnswersAreThoseOfThePersonAndThePageAlone) {
  const Study study = nine_pictures();
  const Preferences preferences = default_preferences(study);
  const EnrolmentPlan plan = plan_enrolment(study, 4, 11);
  const SimulatedPerson person{PersonKind::honest, 42};
  std::set<std::string> ids;
  for (std::size_t page = 0; page < plan.pages.size(); ++page) {
    const json answer = simulate_answer(study, person, plan, page, preferences);
    EXPECT_EQ(answer, simulate_answer(study, person, plan, page, preferences));
    EXPECT_NO_THROW(parse_answer(answer, arm_of(study, plan), plan.pages[page].slots.size()));
    ids.insert(answer["answer_id"].get<std::string>());
  }
  EXPECT_EQ(ids.size(), plan.pages.size());
}

TEST(Simulation, MoreInvertedThanThereArePeopleIsRefused) {
  EXPECT_EQ(field_at_fault([] { simulate_people(5, 6, 0, 1); }), "inverted");
  EXPECT_EQ(field_at_fault([] { simulate_people(5, 3, 3, 1); }), "random");
}

}  // namespace
}  // namespace penumbra::study
