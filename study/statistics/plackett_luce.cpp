#include "study/statistics/plackett_luce.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "study/statistics/quasi_errors.h"

namespace penumbra::study::statistics {

namespace {

using Set = std::vector<std::size_t>;
using Matrix = std::vector<std::vector<double>>;

constexpr std::size_t most_sets = 50'000;  ///< sets to choose from, over all different rests
constexpr int most_steps = 100;
constexpr double most_log = 40.0;      ///< a log worth beyond this runs off to infinity,
constexpr double most_variance = 1e6;  ///< and so does one that is as little known as this

/// One choice: `chosen` took the next place from `left`, both by number.
struct Stage {
  std::uint32_t left = 0;
  std::uint32_t chosen = 0;
  double weight = 1.0;
  std::size_t cluster = 0;
};

/// Sets by number: few are different, however many rankings there are.
class Sets {
 public:
  std::uint32_t number(const Set& set) {
    const auto [found, is_new] = numbers.try_emplace(set, static_cast<std::uint32_t>(list.size()));
    if (is_new) list.push_back(set);
    return found->second;
  }
  const Set& operator[](std::uint32_t number) const { return list[number]; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(list.size()); }

 private:
  std::map<Set, std::uint32_t> numbers;
  std::vector<Set> list;
};

/// Choices with more than one item left; the last one left takes the last place for certain.
struct Choices {
  Sets rests;
  Sets chosen;
  std::vector<Stage> stages;

  explicit Choices(const std::vector<Ranking>& rankings) {
    for (const Ranking& ranking : rankings) {
      Set left;
      for (const Set& place : ranking.places) left.insert(left.end(), place.begin(), place.end());
      std::sort(left.begin(), left.end());
      for (const Set& place : ranking.places) {
        if (left.size() < 2) break;
        stages.push_back(
            {rests.number(left), chosen.number(place), ranking.weight, ranking.cluster});
        for (const std::size_t item : place) left.erase(std::find(left.begin(), left.end(), item));
      }
    }
  }
};

/// Groups of items that comparisons hold together, won or lost; one group where all are held.
std::vector<Set> connected_groups(const Choices& choices, std::size_t items) {
  Set group(items);
  for (std::size_t i = 0; i < items; ++i) group[i] = i;
  const auto root = [&](std::size_t item) {
    while (group[item] != item) item = group[item] = group[group[item]];
    return item;
  };
  for (std::uint32_t i = 0; i < choices.rests.size(); ++i) {
    const Set& rest = choices.rests[i];
    for (const std::size_t item : rest) group[root(item)] = root(rest.front());
  }
  std::map<std::size_t, Set> members;
  for (std::size_t i = 0; i < items; ++i) members[root(i)].push_back(i);
  std::vector<Set> groups;
  for (auto& [first, set] : members) groups.push_back(std::move(set));
  std::sort(groups.begin(), groups.end());
  return groups;
}

/// Whether every item can be reached from the first, along `edges` or against them.
bool all_reached(const std::vector<std::vector<bool>>& edges, bool along) {
  std::vector<bool> reached(edges.size(), false);
  Set open{0};
  reached[0] = true;
  while (!open.empty()) {
    const std::size_t item = open.back();
    open.pop_back();
    for (std::size_t next = 0; next < edges.size(); ++next) {
      if (reached[next] || !(along ? edges[item][next] : edges[next][item])) continue;
      reached[next] = true;
      open.push_back(next);
    }
  }
  return std::find(reached.begin(), reached.end(), false) == reached.end();
}

/// An edge leads from an item to those it was placed before or beside.
bool strongly_connected(const Choices& choices, std::size_t items) {
  std::vector<std::vector<bool>> edges(items, std::vector<bool>(items, false));
  for (const Stage& stage : choices.stages) {
    for (const std::size_t winner : choices.chosen[stage.chosen]) {
      for (const std::size_t other : choices.rests[stage.left]) edges[winner][other] = true;
    }
  }
  return all_reached(edges, true) && all_reached(edges, false);
}

/// The log-linear model: parameters are the log worths of items 1 .. n-1 (item 0 is the reference)
/// and the log prevalence of each tie order that occurs.
class PlackettLuceModel {
 public:
  PlackettLuceModel(const Choices& choices_, std::size_t items_)
      : choices(choices_), items(items_) {
    for (std::uint32_t i = 0; i < choices.chosen.size(); ++i) {
      if (choices.chosen[i].size() > 1) orders.insert(choices.chosen[i].size());
    }
    std::size_t sets = 0;
    for (std::uint32_t i = 0; i < choices.rests.size(); ++i) {
      const Set& left = choices.rests[i];
      std::vector<Eigen::VectorXd> list;
      add_subsets(left, 1, list);
      for (const std::size_t order : orders) {
        if (too_many) break;
        add_subsets(left, order, list);
      }
      sets += list.size();
      too_many = too_many || sets > most_sets;
      if (too_many) return;
      Eigen::MatrixXd& columns = rests.emplace_back(size(), static_cast<Eigen::Index>(list.size()));
      for (std::size_t j = 0; j < list.size(); ++j) {
        columns.col(static_cast<Eigen::Index>(j)) = list[j];
      }
    }
    for (std::uint32_t i = 0; i < choices.chosen.size(); ++i) {
      chosen.push_back(features(choices.chosen[i]));
    }
    rest_weights.assign(rests.size(), 0.0);
    observed = Eigen::VectorXd::Zero(size());
    for (const Stage& stage : choices.stages) {
      rest_weights[stage.left] += stage.weight;
      observed += stage.weight * chosen[stage.chosen];
    }
  }

  bool overflows() const { return too_many; }
  const std::set<std::size_t>& tie_orders() const { return orders; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(items - 1 + orders.size()); }

  struct Value {
    double log_likelihood = 0.0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd information;
  };

  Value evaluate(const Eigen::VectorXd& parameters) const {
    Value value{observed.dot(parameters), observed, Eigen::MatrixXd::Zero(size(), size())};
    for (std::size_t i = 0; i < rests.size(); ++i) {
      const Moments rest = moments_of(rests[i], parameters);
      const double weight = rest_weights[i];
      value.log_likelihood -= weight * rest.log_total;
      value.gradient -= weight * rest.mean;
      value.information += weight * rest.covariance;
    }
    return value;
  }

  /// Sum over clusters of score times score transposed: the filling of the sandwich.
  Eigen::MatrixXd clustered_scores(const Eigen::VectorXd& parameters) const {
    std::map<std::size_t, Eigen::VectorXd> scores;
    std::vector<Eigen::VectorXd> means;
    for (const Eigen::MatrixXd& sets : rests) means.push_back(moments_of(sets, parameters).mean);
    for (const Stage& stage : choices.stages) {
      auto& score = scores.try_emplace(stage.cluster, Eigen::VectorXd::Zero(size())).first->second;
      score += stage.weight * (chosen[stage.chosen] - means[stage.left]);
    }
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size(), size());
    for (const auto& [cluster, score] : scores) sum += score * score.transpose();
    return sum;
  }

 private:
  struct Moments {
    double log_total = 0.0;
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
  };

  /// 1/|S| for each item of S but the reference, and 1 for the order of the tie.
  Eigen::VectorXd features(const Set& set) const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(size());
    for (const std::size_t item : set) {
      if (item > 0) x(static_cast<Eigen::Index>(item) - 1) = 1.0 / static_cast<double>(set.size());
    }
    if (set.size() > 1) {
      const auto at = std::distance(orders.begin(), orders.find(set.size()));
      x(static_cast<Eigen::Index>(items) - 1 + at) = 1.0;
    }
    return x;
  }

  void add_subsets(const Set& left, std::size_t count, std::vector<Eigen::VectorXd>& list) {
    if (count > left.size()) return;
    std::vector<bool> member(left.size(), false);
    std::fill(member.begin(), member.begin() + static_cast<long>(count), true);
    do {
      Set set;
      for (std::size_t i = 0; i < left.size(); ++i) {
        if (member[i]) set.push_back(left[i]);
      }
      list.push_back(features(set));
      if (list.size() > most_sets) {
        too_many = true;
        return;
      }
    } while (std::prev_permutation(member.begin(), member.end()));
  }

  Moments moments_of(const Eigen::MatrixXd& sets, const Eigen::VectorXd& parameters) const {
    const Eigen::VectorXd logs = sets.transpose() * parameters;
    const double largest = logs.maxCoeff();
    const double log_total = largest + std::log((logs.array() - largest).exp().sum());
    const Eigen::VectorXd p = (logs.array() - log_total).exp();
    const Eigen::VectorXd mean = sets * p;
    const Eigen::MatrixXd scaled = sets * p.cwiseSqrt().asDiagonal();
    return {log_total, mean, scaled * scaled.transpose() - mean * mean.transpose()};
  }

  const Choices& choices;
  std::size_t items;
  std::set<std::size_t> orders;
  std::vector<Eigen::MatrixXd> rests;  ///< by rest, a column of features per set that may be chosen
  std::vector<double> rest_weights;
  std::vector<Eigen::VectorXd> chosen;  ///< features of the sets that were
  Eigen::VectorXd observed;             ///< sum of the features of what was chosen
  bool too_many = false;
};

/// Newton's method with step halving; the log-likelihood is concave. False where it runs off.
bool maximise(const PlackettLuceModel& model, Eigen::VectorXd& parameters) {
  parameters = Eigen::VectorXd::Zero(model.size());
  PlackettLuceModel::Value value = model.evaluate(parameters);
  for (int i = 0; i < most_steps; ++i) {
    const Eigen::LDLT<Eigen::MatrixXd> solver(value.information);
    if (solver.info() != Eigen::Success || !solver.isPositive()) return false;
    Eigen::VectorXd step = solver.solve(value.gradient);
    if (!step.allFinite()) return false;
    // Newton's decrement estimates what is left to gain. Below what rounding lets the likelihood
    // show, one last full step squares the error away.
    if (value.gradient.dot(step) < 1e-10 * (1.0 + std::abs(value.log_likelihood))) {
      parameters += step;
      return true;
    }
    PlackettLuceModel::Value next = model.evaluate(parameters + step);
    for (int half = 0; half < 40 && next.log_likelihood < value.log_likelihood; ++half) {
      step *= 0.5;
      next = model.evaluate(parameters + step);
    }
    if (next.log_likelihood < value.log_likelihood) return false;
    parameters += step;
    value = std::move(next);
    if (parameters.cwiseAbs().maxCoeff() > most_log) return false;
  }
  return false;
}

/// The maximum with an imaginary item, last of all, that every item beats and loses to; its own
/// parameter is dropped from the result.
bool maximise_with_pseudo(std::vector<Ranking> rankings, std::size_t items, double pseudo_rankings,
                          Eigen::VectorXd& parameters) {
  for (std::size_t i = 0; i < items; ++i) {
    rankings.push_back({{{i}, {items}}, pseudo_rankings, 0});
    rankings.push_back({{{items}, {i}}, pseudo_rankings, 0});
  }
  const Choices choices(rankings);
  const PlackettLuceModel model(choices, items + 1);
  Eigen::VectorXd all;
  if (model.overflows() || !maximise(model, all)) return false;
  const auto n = static_cast<Eigen::Index>(items);
  parameters.resize(all.size() - 1);
  parameters << all.head(n - 1), all.tail(all.size() - n);
  return true;
}

Matrix rows_of(const Eigen::MatrixXd& matrix) {
  Matrix rows;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    rows.emplace_back();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) rows.back().push_back(matrix(i, j));
  }
  return rows;
}

PlackettLuce without_fit(const std::string& reason) {
  PlackettLuce result;
  result.reason = reason;
  return result;
}

}  // namespace

PlackettLuce fit_plackett_luce(const std::vector<Ranking>& rankings, std::size_t items,
                               double pseudo_rankings) {
  if (items < 2) return without_fit("fewer than two techniques");
  const Choices choices(rankings);
  const auto groups = connected_groups(choices, items);
  if (groups.size() > 1) {
    PlackettLuce result = without_fit(not_connected);
    result.groups = groups;
    return result;
  }
  const bool regularised = pseudo_rankings > 0.0;
  if (!regularised && !strongly_connected(choices, items)) {
    return without_fit("some techniques beat all others every time: worths are unbounded");
  }
  const PlackettLuceModel model(choices, items);
  if (model.overflows()) return without_fit("too many sets of techniques could tie");
  Eigen::VectorXd parameters;
  const bool found = regularised
                         ? maximise_with_pseudo(rankings, items, pseudo_rankings, parameters)
                         : maximise(model, parameters);
  if (!found) return without_fit("no finite maximum of the likelihood");
  const PlackettLuceModel::Value value = model.evaluate(parameters);
  const Eigen::MatrixXd inverse = value.information.inverse();
  if (!(inverse.diagonal().maxCoeff() < most_variance)) {
    return without_fit("no finite maximum of the likelihood");
  }
  const Eigen::MatrixXd sandwich = inverse * model.clustered_scores(parameters) * inverse;

  // Centred log worths are a linear map of the parameters: append the reference, take off the mean.
  const auto n = static_cast<Eigen::Index>(items);
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(n, model.size());
  map.block(1, 0, n - 1, n - 1).setIdentity();
  map.leftCols(n - 1).array() -= 1.0 / static_cast<double>(n);
  const Eigen::VectorXd centred = map * parameters;

  PlackettLuce result;
  result.log_worths.assign(centred.data(), centred.data() + centred.size());
  result.covariance = rows_of(map * inverse * map.transpose());
  result.robust_covariance = rows_of(map * sandwich * map.transpose());
  result.quasi_errors = quasi_errors(result.covariance);
  Eigen::Index at = n - 1;
  for (const std::size_t order : model.tie_orders()) {
    result.log_ties[order] = parameters(at);
    result.tie_errors[order] = std::sqrt(inverse(at, at));
    ++at;
  }
  result.log_likelihood = value.log_likelihood;
  return result;
}

Comparability comparability(const std::vector<Ranking>& rankings, std::size_t items) {
  const Choices choices(rankings);
  return {connected_groups(choices, items), strongly_connected(choices, items)};
}

}  // namespace penumbra::study::statistics
