#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::study::statistics {

/// A ranking with ties, perhaps of some items only: sets of items, best first.
struct Ranking {
  std::vector<std::vector<std::size_t>> places;
  double weight = 1.0;
  std::size_t cluster = 0;  ///< who gave it, for robust errors
};

/// Plackett-Luce with ties of any order (Davidson-Luce; Turner, van Etten, Firth, Kosmidis 2020):
/// the next place is taken by the set S of those left with odds tie_|S| * (product of
/// worths)^(1/|S|). Tie orders that never occur have no odds.
struct PlackettLuce {
  std::vector<double> log_worths;                      ///< centred: they sum to 0
  std::vector<std::vector<double>> covariance;         ///< of the centred log worths
  std::vector<std::vector<double>> robust_covariance;  ///< sandwich, clustered
  std::vector<double> quasi_errors;  ///< Firth's quasi standard errors; empty below three items
  std::map<std::size_t, double> log_ties;    ///< by order, from 2
  std::map<std::size_t, double> tie_errors;  ///< of log_ties
  double log_likelihood = 0.0;
  std::string reason;  ///< why there is no fit; everything else is empty then
  /// Items by the groups that comparisons hold together, where those are several: nothing says how
  /// one group compares with another.
  std::vector<std::vector<std::size_t>> groups;
};

/// Maximum likelihood by Newton's method; no pseudo-rankings. A fit exists where the comparisons
/// are strongly connected: no set of items beats all others in every ranking (Hunter 2004);
/// otherwise, and where sets to tie are too many to count, `reason` says so.
///
/// With `pseudo_rankings` above zero every item also wins and loses so many comparisons with one
/// imaginary item (Turner et al. 2020: 0.5): worths stay finite where an item beats all others.
/// Likelihood and errors are then those of the real rankings at these worths. Groups that were
/// never compared are not fitted either way.
PlackettLuce fit_plackett_luce(const std::vector<Ranking>& rankings, std::size_t items,
                               double pseudo_rankings = 0.0);

/// Reason of items that fall into groups without a comparison between them.
inline constexpr const char* not_connected = "not connected: some techniques were never compared";

struct Comparability {
  std::vector<std::vector<std::size_t>> groups;  ///< held together by comparisons, won or lost
  bool bounded = false;                          ///< no set of items beats all others every time
};
Comparability comparability(const std::vector<Ranking>& rankings, std::size_t items);

}  // namespace penumbra::study::statistics
