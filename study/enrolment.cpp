#include "study/enrolment.h"

#include <algorithm>

#include "study/random.h"

namespace penumbra::study {

namespace {

/// Row `row` of the square of `count` treatments in which, over all rows, each follows each other
/// equally often (Williams 1949): 0, 1, n-1, 2, n-2, ... shifted by the row. With odd `count` that
/// holds only together with the mirrored rows.
std::vector<std::size_t> williams_row(std::size_t count, std::size_t row, bool mirrored) {
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t step = i % 2 == 1 ? (i + 1) / 2 : (count - i / 2) % count;
    order[i] = (step + row) % count;
  }
  if (mirrored) std::reverse(order.begin(), order.end());
  return order;
}

/// Order of `count` things for a place. Places n*b .. n*b+n-1 take the rows of one square, so
/// within any run from place 0 each thing stands at each position equally often, give or take one.
std::vector<std::size_t> balanced_order(std::size_t count, Permutations& permutations,
                                        std::uint32_t stream, std::size_t place) {
  const std::size_t block = place / count;
  const bool odd = count % 2 == 1;
  // The two squares of an odd count share their labels, or their balance would be lost.
  const std::size_t labelling = odd ? block / 2 : block;
  const std::size_t row = permutations.of(2 * stream + 1, block, count)[place % count];
  auto order = williams_row(count, row, odd && block % 2 == 1);
  const auto& labels = permutations.of(2 * stream, labelling, count);
  for (std::size_t& item : order) item = labels[item];
  return order;
}

/// Parts a repeated page from its first showing: a second one of the last page moves behind the
/// others, or where it is the only one, the last two pages change places.
void keep_apart(std::vector<PlannedPage>& shown, const std::vector<std::size_t>& repeats,
                std::vector<std::size_t>& order) {
  if (repeats[order.front()] != shown.back().page) return;
  if (order.size() > 1)
    std::rotate(order.begin(), order.begin() + 1, order.end());
  else
    std::swap(shown[shown.size() - 2], shown[shown.size() - 1]);
}

constexpr std::uint32_t stream_arms = 1000;  // beyond those of 100 pages and their repeats

}  // namespace

const std::vector<std::size_t>& Permutations::of(std::uint32_t stream, std::size_t index,
                                                 std::size_t count) {
  const auto key = std::make_tuple(stream, index, count);
  const auto known = kept.find(key);
  if (known != kept.end()) return known->second;
  if (kept.size() == most_kept) kept.clear();
  return kept[key] = Random(seed, stream, index).permutation(count);
}

std::size_t next_place(std::span<const PlaceState> places) {
  const auto free = std::find(places.begin(), places.end(), PlaceState::dropped);
  return static_cast<std::size_t>(free - places.begin());
}

EnrolmentPlan plan_enrolment(const Study& study, std::uint64_t seed, std::size_t place) {
  Permutations permutations(seed);
  return plan_enrolment(study, permutations, place);
}

EnrolmentPlan plan_enrolment(const Study& study, Permutations& permutations,
                             std::size_t given_place) {
  const std::size_t arms = study.arms.size();
  const std::size_t place = given_place / arms;  // within the arm
  EnrolmentPlan plan{permutations.seed, given_place, 0, {}};
  if (arms > 1) plan.arm = permutations.of(stream_arms, place, arms)[given_place % arms];
  // Streams: 0 order of pages, 1 practice, 2 order of repeats, then one per page and repeat.
  const auto first_stream = std::uint32_t{3};
  const auto pages = static_cast<std::uint32_t>(study.pages.size());
  if (study.practice) {
    const std::size_t count = study.practice->page.pictures.size();
    plan.pages.push_back({PageKind::practice, 0, balanced_order(count, permutations, 1, place)});
  }
  for (const std::size_t page : balanced_order(study.pages.size(), permutations, 0, place)) {
    const auto stream = first_stream + static_cast<std::uint32_t>(page);
    plan.pages.push_back(
        {PageKind::ranking, page,
         balanced_order(study.pages[page].pictures.size(), permutations, stream, place)});
  }
  if (!study.repeats.empty()) {
    auto order = balanced_order(study.repeats.size(), permutations, 2, place);
    keep_apart(plan.pages, study.repeats, order);
    for (const std::size_t index : order) {
      const std::size_t page = study.repeats[index];
      const auto stream = first_stream + pages + static_cast<std::uint32_t>(page);
      plan.pages.push_back(
          {PageKind::repeat, page,
           balanced_order(study.pages[page].pictures.size(), permutations, stream, place)});
    }
  }
  return plan;
}

const Arm& arm_of(const Study& study, const EnrolmentPlan& plan) {
  return study.arms.at(plan.arm);
}

const char* kind_name(PageKind kind) {
  return kind == PageKind::practice ? "practice" : kind == PageKind::repeat ? "repeat" : "ranking";
}

const Page& page_of(const Study& study, const PlannedPage& planned) {
  return planned.kind == PageKind::practice ? study.practice.value().page
                                            : study.pages.at(planned.page);
}

}  // namespace penumbra::study
