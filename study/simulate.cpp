#include "study/simulate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/error.h"
#include "study/random.h"

namespace penumbra::study {

namespace {

using nlohmann::json;

// Streams of the random numbers of one person or study.
constexpr std::uint32_t stream_people = 100;
constexpr std::uint32_t stream_ranks = 101;
constexpr std::uint32_t stream_other = 102;
constexpr std::uint32_t stream_uuid = 103;

/// Up to three pictures that may share the next shelf, and how likely.
struct Choice {
  std::array<std::size_t, 3> pictures{};
  std::size_t count = 0;
  double odds = 0.0;
};

/// All sets of one, two and three of the pictures left, into `list`.
void find_choices(const std::vector<std::size_t>& left, const std::vector<double>& log_worths,
                  const Preferences& preferences, std::vector<Choice>& list) {
  list.clear();
  const auto add = [&](std::array<std::size_t, 3> pictures, std::size_t count, double tie) {
    if (!(tie > 0.0)) return;
    double log_product = 0.0;
    for (std::size_t i = 0; i < count; ++i) log_product += log_worths[pictures[i]];
    list.push_back({pictures, count, tie * std::exp(log_product / static_cast<double>(count))});
  };
  for (std::size_t i = 0; i < left.size(); ++i) {
    add({left[i]}, 1, 1.0);
    for (std::size_t j = i + 1; j < left.size(); ++j) {
      add({left[i], left[j]}, 2, preferences.tie_of_two);
      for (std::size_t k = j + 1; k < left.size(); ++k) {
        add({left[i], left[j], left[k]}, 3, preferences.tie_of_three);
      }
    }
  }
}

/// A version 4 UUID.
std::string draw_uuid(Random& random) {
  std::string text;
  std::array<std::uint64_t, 2> words{random.bits(), random.bits()};
  words[0] = (words[0] & ~0xF000ull) | 0x4000ull;
  words[1] = (words[1] & ~(3ull << 62)) | (2ull << 62);
  for (int digit = 0; digit < 32; ++digit) {
    if (digit == 8 || digit == 12 || digit == 16 || digit == 20) text += '-';
    const auto word = words[static_cast<std::size_t>(digit / 16)];
    text += "0123456789abcdef"[(word >> (60 - 4 * (digit % 16))) & 15];
  }
  return text;
}

std::vector<double> worths_of(const Page& page, const PlannedPage& planned,
                              const SimulatedPerson& person, const Preferences& preferences) {
  std::vector<double> log_worths;
  const std::size_t count = page.pictures.size();
  for (const std::size_t index : planned.slots) {
    double worth = 0.0;
    const auto known = preferences.log_worths.find(page.pictures[index].id);
    if (known != preferences.log_worths.end()) worth = known->second;
    // The practice page's answer is obvious: it is meant for learning the widget.
    if (planned.kind == PageKind::practice) worth = 4.0 * static_cast<double>(count - index);
    if (person.kind == PersonKind::random) worth = 0.0;
    log_worths.push_back(worth);
  }
  return log_worths;
}

}  // namespace

std::vector<int> draw_shelves(const std::vector<double>& log_worths, const Preferences& preferences,
                              Random& random) {
  std::vector<int> shelves(log_worths.size(), 0);
  std::vector<std::size_t> left(log_worths.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<Choice> list;
  for (int shelf = 0; !left.empty(); ++shelf) {
    find_choices(left, log_worths, preferences, list);
    double total = 0.0;
    for (const Choice& choice : list) total += choice.odds;
    double at = random.uniform() * total;
    std::size_t chosen = 0;
    while (chosen + 1 < list.size() && at >= list[chosen].odds) at -= list[chosen++].odds;
    for (std::size_t i = 0; i < list[chosen].count; ++i) {
      const std::size_t picture = list[chosen].pictures[i];
      shelves[picture] = shelf;
      left.erase(std::find(left.begin(), left.end(), picture));
    }
  }
  return shelves;
}

Preferences default_preferences(const Study& study, double step) {
  Preferences preferences;
  const auto& pictures = study.pages.front().pictures;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    preferences.log_worths[pictures[i].id] = step * static_cast<double>(i);
  }
  return preferences;
}

std::vector<SimulatedPerson> simulate_people(std::size_t participants, std::size_t inverted,
                                             std::size_t random, std::uint64_t seed) {
  if (inverted > participants) throw bad_value("inverted", "more than there are participants");
  if (random > participants - inverted) {
    throw bad_value("random", "more than there are participants beside the inverted ones");
  }
  Random numbers(seed, stream_people);
  std::vector<SimulatedPerson> people(participants);
  const auto order = numbers.permutation(participants);
  for (std::size_t i = 0; i < participants; ++i) {
    SimulatedPerson& person = people[order[i]];
    person.seed = numbers.bits();
    if (i < inverted)
      person.kind = PersonKind::inverted;
    else if (i < inverted + random)
      person.kind = PersonKind::random;
  }
  return people;
}

json simulate_answer(const Study& study, const SimulatedPerson& person, const EnrolmentPlan& plan,
                     std::size_t page_index, const Preferences& preferences) {
  const PlannedPage& planned = plan.pages.at(page_index);
  const Page& page = page_of(study, planned);
  Random ranks(person.seed, stream_ranks, page_index);
  auto shelves = draw_shelves(worths_of(page, planned, person, preferences), preferences, ranks);
  // People who read what a page asks for do as an attention item says.
  if (!page.counted() && person.kind != PersonKind::random)
    std::fill(shelves.begin(), shelves.end(), 0);
  const int last = *std::max_element(shelves.begin(), shelves.end());
  const bool inverted = person.kind == PersonKind::inverted;
  const Arm& arm = arm_of(study, plan);
  const bool numeric = arm.widget == Widget::numeric;
  json places = json::object();
  for (std::size_t slot = 0; slot < shelves.size(); ++slot) {
    const int shelf = inverted ? last - shelves[slot] : shelves[slot];
    places[std::to_string(slot)] =
        numeric ? digit_from_best(std::min(shelf + 1, 9), arm.best_digit) : shelf;
  }
  Random other(person.seed, stream_other, page_index);
  Random uuid(person.seed, stream_uuid, page_index);
  // Four to ten seconds per picture: an unhurried person.
  const double active =
      1000.0 * static_cast<double>(shelves.size()) * (4.0 + 6.0 * other.uniform());
  return {{"answer_id", draw_uuid(uuid)},
          {numeric ? "digits" : "shelves", places},
          {"difficulty", 1 + static_cast<int>(other.below(5))},
          {"active_ms", std::round(active)},
          {"total_ms", std::round(active * (1.0 + 0.2 * other.uniform()))}};
}

std::vector<ResponseRow> simulate_responses(const Study& study,
                                            const std::vector<SimulatedPerson>& people,
                                            const Preferences& preferences, std::uint64_t seed) {
  const std::string hash = study_hash(study);
  std::vector<ResponseRow> rows;
  for (std::size_t i = 0; i < people.size(); ++i) {
    const EnrolmentPlan plan = plan_enrolment(study, seed, i);
    const std::string number = std::to_string(i + 1);
    const std::string name =
        "S" + std::string(number.size() < 6 ? 6 - number.size() : 0, '0') + number;
    for (std::size_t j = 0; j < plan.pages.size(); ++j) {
      if (plan.pages[j].kind == PageKind::practice || !page_of(study, plan.pages[j]).counted())
        continue;
      const json body = simulate_answer(study, people[i], plan, j, preferences);
      const Arm& arm = arm_of(study, plan);
      const Answer answer = parse_answer(body, arm, plan.pages[j].slots.size());
      const auto page_rows =
          response_rows(study, hash, name, arm, plan.pages[j], static_cast<int>(j), answer, "");
      rows.insert(rows.end(), page_rows.begin(), page_rows.end());
    }
  }
  return rows;
}

}  // namespace penumbra::study
