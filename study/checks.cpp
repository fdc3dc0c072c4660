#include "study/checks.h"

#include <algorithm>

namespace penumbra::study {

namespace {

std::string name_of(const Page& page, PageKind kind) {
  return page.id + (kind == PageKind::repeat ? ".again" : "");
}

/// Place of the picture called `id` on a page as one person saw it.
int place_of(const std::string& id, const Page& page, const PlannedPage& planned,
             const std::vector<int>& order) {
  for (std::size_t slot = 0; slot < planned.slots.size(); ++slot)
    if (page.pictures.at(planned.slots[slot]).id == id) return order.at(slot);
  throw std::logic_error("the page has no picture " + id);
}

int failures_of(const PersonChecks& checks, bool attention) {
  return static_cast<int>(std::count_if(
      checks.pages.begin(), checks.pages.end(),
      [&](const CheckedPage& page) { return page.attention == attention && !page.met; }));
}

bool is_dim(const Study& study, const PersonChecks& checks) {
  return checks.patches_seen && *checks.patches_seen < study.brightness.minimum_patches;
}

}  // namespace

int PersonChecks::failures() const {
  return failures_of(*this, true) + failures_of(*this, false);
}

std::vector<std::string> checked_pages(const Study& study) {
  std::vector<std::string> names;
  for (const Page& page : study.pages)
    if (page.expected) names.push_back(name_of(page, PageKind::ranking));
  for (const std::size_t index : study.repeats)
    if (study.pages.at(index).expected)
      names.push_back(name_of(study.pages[index], PageKind::repeat));
  return names;
}

bool meets(const Expectation& expected, const Page& page, const PlannedPage& planned,
           const std::vector<int>& order) {
  if (expected.all_same)
    return std::adjacent_find(order.begin(), order.end(), std::not_equal_to<>()) == order.end();
  return place_of(expected.better, page, planned, order) <
         place_of(expected.worse, page, planned, order);
}

bool practice_is_right(const PlannedPage& planned, const std::vector<int>& order) {
  std::vector<int> places(order.size());
  for (std::size_t slot = 0; slot < order.size(); ++slot)
    places.at(planned.slots.at(slot)) = order[slot];
  return std::is_sorted(places.begin(), places.end()) && places.front() < places.back();
}

PersonChecks checks_of(const Study& study, const EnrolmentPlan& plan,
                       const std::vector<std::pair<std::size_t, nlohmann::json>>& answers,
                       const nlohmann::json& details) {
  PersonChecks checks;
  for (const auto& [position, body] : answers) {
    const PlannedPage& planned = plan.pages.at(position);
    const Page& page = page_of(study, planned);
    const bool practice = planned.kind == PageKind::practice;
    if (!practice && !page.expected) continue;
    const Answer answer = parse_answer(body, arm_of(study, plan), planned.slots.size(), practice);
    if (practice)
      checks.practice_right = practice_is_right(planned, answer.order);
    else
      checks.pages.push_back({name_of(page, planned.kind), page.expected->all_same,
                              meets(*page.expected, page, planned, answer.order)});
  }
  if (details.contains("patches_seen")) checks.patches_seen = details.at("patches_seen").get<int>();
  return checks;
}

bool is_screened_out(const Study& study, const PersonChecks& checks) {
  const bool dim = study.brightness.consequence == Consequence::screen_out && is_dim(study, checks);
  const bool failed = study.expectations.consequence == Consequence::screen_out &&
                      checks.failures() > study.expectations.allowed_failures;
  return dim || failed;
}

bool can_screen_out(const Study& study) {
  return study.brightness.consequence == Consequence::screen_out ||
         study.expectations.consequence == Consequence::screen_out;
}

std::vector<GivenFlag> check_flags(const Study& study, const std::string& participant,
                                   const PersonChecks& checks) {
  std::vector<GivenFlag> flags;
  const int allowed = study.expectations.allowed_failures;
  if (checks.failures() > allowed) {
    if (const int failed = failures_of(checks, true); failed > 0)
      flags.push_back({participant, "attention", static_cast<double>(failed),
                       static_cast<double>(allowed),
                       "attention items answered otherwise than asked"});
    if (const int failed = failures_of(checks, false); failed > 0)
      flags.push_back({participant, "gold", static_cast<double>(failed),
                       static_cast<double>(allowed),
                       "pictures of known order put the wrong way round"});
  }
  if (is_dim(study, checks))
    flags.push_back({participant, "dim_screen", static_cast<double>(*checks.patches_seen),
                     static_cast<double>(study.brightness.minimum_patches),
                     "dark patches told apart on this screen"});
  if (checks.entries > 1)
    flags.push_back({participant, "several_entries", static_cast<double>(checks.entries), 1.0,
                     "entries under the same name in the link"});
  return flags;
}

}  // namespace penumbra::study
