#include "study/statistics/plackett_luce.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

namespace penumbra::study::statistics {

namespace {

using Set = std::vector<std::size_t>;
using Matrix = std::vector<std::vector<double>>;

constexpr std::size_t most_sets = 50'000;  ///< sets to choose from, over all different rests
constexpr int most_steps = 100;
constexpr double most_log = 40.0;      ///< a log worth beyond this runs off to infinity,
constexpr double most_variance = 1e6;  ///< and so does one that is as little known as this

/// One choice: `chosen` took the next place from `left`.
struct Stage {
  Set left;
  Set chosen;
  double weight = 1.0;
  std::size_t cluster = 0;
};

/// Choices with more than one item left; the last one left takes the last place for certain.
std::vector<Stage> stages_of(const std::vector<Ranking>& rankings) {
  std::vector<Stage> stages;
  for (const Ranking& ranking : rankings) {
    Set left;
    for (const Set& place : ranking.places) left.insert(left.end(), place.begin(), place.end());
    std::sort(left.begin(), left.end());
    for (const Set& place : ranking.places) {
      if (left.size() < 2) break;
      stages.push_back({left, place, ranking.weight, ranking.cluster});
      for (const std::size_t item : place) left.erase(std::find(left.begin(), left.end(), item));
    }
  }
  return stages;
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

/// Groups of items that comparisons hold together, whoever won; one group where all are held.
std::vector<Set> connected_groups(const std::vector<Stage>& stages, std::size_t items) {
  Set group(items);
  for (std::size_t i = 0; i < items; ++i) group[i] = i;
  const auto root = [&](std::size_t item) {
    while (group[item] != item) item = group[item] = group[group[item]];
    return item;
  };
  for (const Stage& stage : stages) {
    for (const std::size_t item : stage.left) group[root(item)] = root(stage.left.front());
  }
  std::map<std::size_t, Set> members;
  for (std::size_t i = 0; i < items; ++i) members[root(i)].push_back(i);
  std::vector<Set> groups;
  for (auto& [first, set] : members) groups.push_back(std::move(set));
  std::sort(groups.begin(), groups.end());
  return groups;
}

/// An edge leads from an item to those it was placed before or beside.
bool strongly_connected(const std::vector<Stage>& stages, std::size_t items) {
  std::vector<std::vector<bool>> edges(items, std::vector<bool>(items, false));
  for (const Stage& stage : stages) {
    for (const std::size_t winner : stage.chosen) {
      for (const std::size_t other : stage.left) edges[winner][other] = true;
    }
  }
  return all_reached(edges, true) && all_reached(edges, false);
}

/// The log-linear model: parameters are the log worths of items 1 .. n-1 (item 0 is the reference)
/// and the log prevalence of each tie order that occurs.
class Model {
 public:
  Model(std::vector<Stage> stages_, std::size_t items_)
      : stages(std::move(stages_)), items(items_) {
    for (const Stage& stage : stages) {
      if (stage.chosen.size() > 1) orders.insert(stage.chosen.size());
    }
    std::size_t sets = 0;
    for (const Stage& stage : stages) {
      rest_weights[stage.left] += stage.weight;
      if (rests.contains(stage.left)) continue;
      std::vector<Eigen::VectorXd> list;
      add_subsets(stage.left, 1, list);
      for (const std::size_t order : orders) {
        if (too_many) break;
        add_subsets(stage.left, order, list);
      }
      sets += list.size();
      too_many = too_many || sets > most_sets;
      if (too_many) return;
      Eigen::MatrixXd& columns = rests[stage.left];
      columns.resize(size(), static_cast<Eigen::Index>(list.size()));
      for (std::size_t i = 0; i < list.size(); ++i) {
        columns.col(static_cast<Eigen::Index>(i)) = list[i];
      }
    }
    observed = Eigen::VectorXd::Zero(size());
    for (const Stage& stage : stages) observed += stage.weight * features(stage.chosen);
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
    for (const auto& [left, sets] : rests) {
      const Moments rest = moments_of(sets, parameters);
      const double weight = rest_weights.at(left);
      value.log_likelihood -= weight * rest.log_total;
      value.gradient -= weight * rest.mean;
      value.information += weight * rest.covariance;
    }
    return value;
  }

  /// Sum over clusters of score times score transposed: the filling of the sandwich.
  Eigen::MatrixXd clustered_scores(const Eigen::VectorXd& parameters) const {
    std::map<std::size_t, Eigen::VectorXd> scores;
    std::map<Set, Eigen::VectorXd> means;
    for (const auto& [left, sets] : rests) means[left] = moments_of(sets, parameters).mean;
    for (const Stage& stage : stages) {
      auto& score = scores.try_emplace(stage.cluster, Eigen::VectorXd::Zero(size())).first->second;
      score += stage.weight * (features(stage.chosen) - means.at(stage.left));
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

  std::vector<Stage> stages;
  std::size_t items;
  std::set<std::size_t> orders;
  std::map<Set, Eigen::MatrixXd> rests;  ///< a column of features per set that may be chosen
  std::map<Set, double> rest_weights;
  Eigen::VectorXd observed;  ///< sum of the features of what was chosen
  bool too_many = false;
};

/// Newton's method with step halving; the log-likelihood is concave. False where it runs off.
bool maximise(const Model& model, Eigen::VectorXd& parameters) {
  parameters = Eigen::VectorXd::Zero(model.size());
  Model::Value value = model.evaluate(parameters);
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
    Model::Value next = model.evaluate(parameters + step);
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
  const Model model(stages_of(rankings), items + 1);
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
  const auto stages = stages_of(rankings);
  const auto groups = connected_groups(stages, items);
  if (groups.size() > 1) {
    PlackettLuce result = without_fit("not connected: some techniques were never compared");
    result.groups = groups;
    return result;
  }
  const bool regularised = pseudo_rankings > 0.0;
  if (!regularised && !strongly_connected(stages, items)) {
    return without_fit("some techniques beat all others every time: worths are unbounded");
  }
  const Model model(stages, items);
  if (model.overflows()) return without_fit("too many sets of techniques could tie");
  Eigen::VectorXd parameters;
  const bool found = regularised
                         ? maximise_with_pseudo(rankings, items, pseudo_rankings, parameters)
                         : maximise(model, parameters);
  if (!found) return without_fit("no finite maximum of the likelihood");
  const Model::Value value = model.evaluate(parameters);
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

std::vector<double> quasi_errors(const Matrix& covariance) {
  const std::size_t count = covariance.size();
  if (count < 3) return {};
  const auto n = static_cast<Eigen::Index>(count);
  const Eigen::Index pairs = n * (n - 1) / 2;
  // Gauss-Newton on log(q_i + q_j) = log v_ij in the quasi-variances q, from half the mean
  // variance.
  Eigen::VectorXd target(pairs);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      target(row++) = covariance[i][i] + covariance[j][j] - 2.0 * covariance[i][j];
    }
  }
  Eigen::VectorXd quasi = Eigen::VectorXd::Constant(n, 0.5 * target.mean());
  for (int step = 0; step < 200; ++step) {
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(pairs, n);
    Eigen::VectorXd residual(pairs);
    row = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = i + 1; j < n; ++j, ++row) {
        const double sum = quasi(i) + quasi(j);
        if (!(sum > 0.0)) return {};
        jacobian(row, i) = jacobian(row, j) = 1.0 / sum;
        residual(row) = std::log(target(row) / sum);
      }
    }
    const Eigen::VectorXd change = jacobian.colPivHouseholderQr().solve(residual);
    quasi += change;
    if (change.cwiseAbs().maxCoeff() < 1e-14 * quasi.cwiseAbs().maxCoeff()) break;
  }
  std::vector<double> errors;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!(quasi(i) >= 0.0)) return {};  // Firth: negative quasi-variances exist, errors do not
    errors.push_back(std::sqrt(quasi(i)));
  }
  return errors;
}

}  // namespace penumbra::study::statistics
