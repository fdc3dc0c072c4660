#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "study/study.h"

namespace penumbra::study {

enum class PageKind { practice, ranking, repeat };

/// "practice", "ranking" or "repeat".
const char* kind_name(PageKind kind);

/// One page as one participant sees it.
struct PlannedPage {
  PageKind kind = PageKind::ranking;
  std::size_t page = 0;            ///< index into Study::pages; unused for the practice page
  std::vector<std::size_t> slots;  ///< slots[s] is the index of the picture at position s
};

/// What a person is shown, in order. A pure function of study, seed and place.
struct EnrolmentPlan {
  std::uint64_t seed = 0;  ///< the study's, recorded with every participant
  std::size_t place = 0;
  std::size_t arm = 0;  ///< index into Study::arms
  std::vector<PlannedPage> pages;
};

/// What the holder of a place is: still answering, done, or gone.
enum class PlaceState { open, completed, dropped };

/// The place of the next person: the first that was dropped, otherwise a new one. `places[p]` is
/// the state of place p.
std::size_t next_place(std::span<const PlaceState> places);

/// Random permutations of one seed, kept: neighbouring places share them, and drawing one (seeding
/// a Mersenne twister) costs a hundred times what a plan takes otherwise. Not thread-safe.
class Permutations {
 public:
  explicit Permutations(std::uint64_t seed_) : seed(seed_) {}

  /// 0 .. count - 1 in random order; a pure function of seed, stream, index and count. Valid until
  /// the next call.
  const std::vector<std::size_t>& of(std::uint32_t stream, std::size_t index, std::size_t count);

  const std::uint64_t seed;

 private:
  static constexpr std::size_t most_kept = 32768;  // some 4 MB
  std::map<std::tuple<std::uint32_t, std::size_t, std::size_t>, std::vector<std::size_t>> kept;
};

/// Order of pages and of pictures for a place. All places of a study share one `seed`; consecutive
/// places walk through Williams squares (Williams 1949), so that over places 0..N-1 how often a
/// page or picture stands at a position differs by at most one, and over whole squares every
/// picture follows every other equally often. Squares are relabelled and their rows shuffled from
/// the seed, each page on its own, so that the order of pages tells nothing about the order of
/// pictures. With several arms, every run of as many places holds each arm once, in random order
/// (permuted blocks), and its people see the same orders: each arm walks through the same squares.
EnrolmentPlan plan_enrolment(const Study& study, std::uint64_t seed, std::size_t place);

/// The same with permutations that are kept for the next place.
EnrolmentPlan plan_enrolment(const Study& study, Permutations& permutations, std::size_t place);

/// How the person gives ranks.
const Arm& arm_of(const Study& study, const EnrolmentPlan& plan);

/// The page behind a planned page (the practice page where it is one).
const Page& page_of(const Study& study, const PlannedPage& planned);

}  // namespace penumbra::study
