#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/study.h"

namespace penumbra::study {

inline constexpr double max_ms = 1e10;  ///< of any time that a page takes: four months

struct PageSize {
  double width = 0.0;
  double height = 0.0;
};

/// What the page noted beside the ranks; nothing else about the person.
struct Observations {
  std::optional<double> active_ms;  ///< page in front and focused
  std::optional<double> total_ms;
  int enlargements = 0;  ///< how often a picture was enlarged
  int flips = 0;         ///< how often two were flipped in place
  int turns = 0;         ///< how often the view was turned
  int frames_seen = 0;   ///< views that were seen; 0 where the page has one only
  int swaps = 0;         ///< uses of the button "other way round"; ranks are those after it
  int blurs = 0;         ///< how often the window lost focus
  int load_failures = 0;
  bool all_same = false;           ///< "all look the same" was chosen
  std::vector<int> order_shown;    ///< slots, empty: in their own order
  std::optional<PageSize> window;  ///< CSS pixels
  std::optional<PageSize> screen;  ///< CSS pixels
  std::optional<double> device_pixel_ratio;
  std::string started_at;   ///< by the browser's clock, as it was sent
  std::string answered_at;  ///< by the browser's clock, as it was sent
};

struct Answer {
  std::string answer_id;     ///< UUID, lower case
  std::vector<int> shelves;  ///< per slot, 0 most realistic; empty for digits
  std::vector<int> digits;   ///< per slot, as typed; empty for shelves
  std::vector<int>
      order;           ///< per slot: equal numbers are equal ranks, the lowest is most realistic
  int difficulty = 0;  ///< 1 (hard to see) .. 5 (easy); 0 on a practice page without one
  Observations observations;
};

/// Checks the body of PUT .../pages/{page}:
///   answer_id    UUID
///   shelves      {"0": 0, "1": 2, ...}: each slot's shelf, 0 .. slots - 1    (arm of shelves)
///   digits       {"0": 1, "1": 9, ...}: each slot's digit, 1 .. 9            (numeric arm)
///   difficulty   1 .. 5, required unless `practice`
///   active_ms, total_ms, enlargements, flips, turns, frames_seen, swaps, blurs, load_failures,
///   all_same, order_shown [slot..], window {width, height}, screen {width, height},
///   device_pixel_ratio, started_at, answered_at (ISO 8601, the browser's clock)    optional
/// Every slot is required. Throws bad_value naming the field: `shelves.3`, `difficulty`, ...
Answer parse_answer(const nlohmann::json& body, const Arm& arm, std::size_t slots,
                    bool practice = false);

/// Equal but for key order and number notation: the same answer sent again.
bool same_answer(const nlohmann::json& a, const nlohmann::json& b);

/// Twice the mid-rank of each value (integers, so that ties are exact): 3, 1, 1 gives 6, 3, 3.
std::vector<int> doubled_mid_ranks(const std::vector<int>& values);

}  // namespace penumbra::study
