#include "study/statistics/jod.h"

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "study/statistics/distributions.h"
#include "study/statistics/json.h"
#include "study/statistics/worths.h"

namespace penumbra::study::statistics {

namespace {

using nlohmann::json;

constexpr double case_five_sigma =
    1.4826022185056018;              ///< 1 / quantile(0.75): P = 0.75 at a distance of 1
constexpr double prior_floor = 0.1;  ///< added to the prior, theirs
constexpr double most_jod = 20.0;    ///< a score beyond runs off to infinity
constexpr int most_newton_steps = 500;

double density(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2.0 * 3.14159265358979323846);
}

/// A pair that was compared, seen from `a`. Every pair is there once in either direction, as the
/// prior is over both.
struct Comparison {
  Eigen::Index a = 0;
  Eigen::Index b = 0;
  double wins = 0.0;
  double losses = 0.0;
  double prior_wins = 0.0;  ///< unanimous answers shifted by one towards doubt
};

/// P(a before b) at the current distance, and what its logarithms change by per JOD.
struct Chance {
  double log_win = 0.0;
  double log_loss = 0.0;
  double win_slope = 0.0;   ///< d log P
  double loss_slope = 0.0;  ///< d log (1 - P)
};

Chance chance_at(double distance) {
  const double x = distance / case_five_sigma;
  const double win = normal_tail(-x);
  const double loss = normal_tail(x);
  return {std::log(win), std::log(loss), density(x) / (case_five_sigma * win),
          -density(x) / (case_five_sigma * loss)};
}

class ThurstoneModel {
 public:
  ThurstoneModel(const Table& wins, bool prior_)
      : items(static_cast<Eigen::Index>(wins.size())), prior(prior_) {
    for (std::size_t a = 0; a < wins.size(); ++a) {
      for (std::size_t b = 0; b < wins.size(); ++b) {
        const double won = wins[a][b];
        const double lost = wins[b][a];
        if (a == b || !(won + lost > 0.0)) continue;
        double shifted = won;
        if (!(won > 0.0)) shifted = std::min(1.0, lost);
        if (!(lost > 0.0)) shifted = std::max(0.0, won - 1.0);
        comparisons.push_back(
            {static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b), won, lost, shifted});
      }
    }
  }

  struct Value {
    double objective = 0.0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd information;  ///< Fisher's, of the likelihood alone
  };

  Value evaluate(const Eigen::VectorXd& scores) const {
    std::vector<Chance> chances;
    for (const Comparison& pair : comparisons) {
      chances.push_back(chance_at(scores(pair.a) - scores(pair.b)));
    }
    std::vector<double> slopes(comparisons.size(), 0.0);
    Value value{0.0, Eigen::VectorXd::Zero(items), Eigen::MatrixXd::Zero(items, items)};
    for (std::size_t i = 0; i < comparisons.size(); ++i) {
      const Comparison& pair = comparisons[i];
      const Chance& chance = chances[i];
      value.objective += pair.wins * chance.log_win + pair.losses * chance.log_loss;
      slopes[i] += pair.wins * chance.win_slope + pair.losses * chance.loss_slope;
      const double weight = -(pair.wins + pair.losses) * chance.win_slope * chance.loss_slope;
      value.information(pair.a, pair.a) += weight;
      value.information(pair.b, pair.b) += weight;
      value.information(pair.a, pair.b) -= weight;
      value.information(pair.b, pair.a) -= weight;
    }
    if (prior) add_prior(chances, value.objective, slopes);
    for (std::size_t i = 0; i < comparisons.size(); ++i) {
      value.gradient(comparisons[i].a) += slopes[i];
      value.gradient(comparisons[i].b) -= slopes[i];
    }
    return value;
  }

 private:
  /// log(0.1 + sum over pairs j of L_ij / sum over i' of L_i'j), where L_ij is how likely distance
  /// i makes the answers of pair j.
  void add_prior(const std::vector<Chance>& chances, double& objective,
                 std::vector<double>& slopes) const {
    const auto n = static_cast<Eigen::Index>(comparisons.size());
    Eigen::MatrixXd share(n, n);
    Eigen::MatrixXd change(n, n);  // of log L_ij by distance i
    for (Eigen::Index j = 0; j < n; ++j) {
      const Comparison& pair = comparisons[static_cast<std::size_t>(j)];
      const double losses = pair.wins + pair.losses - pair.prior_wins;
      for (Eigen::Index i = 0; i < n; ++i) {
        const Chance& chance = chances[static_cast<std::size_t>(i)];
        share(i, j) = pair.prior_wins * chance.log_win + losses * chance.log_loss;
        change(i, j) = pair.prior_wins * chance.win_slope + losses * chance.loss_slope;
      }
      const double largest = share.col(j).maxCoeff();
      share.col(j) = (share.col(j).array() - largest).exp();
      share.col(j) /= share.col(j).sum();
    }
    const Eigen::VectorXd total = share.rowwise().sum().array() + prior_floor;
    const Eigen::VectorXd inverse = total.cwiseInverse();
    objective += total.array().log().sum();
    const Eigen::VectorXd by_pair = share.transpose() * inverse;
    const Eigen::MatrixXd moved = share.cwiseProduct(change);
    const Eigen::VectorXd slope = inverse.cwiseProduct(moved.rowwise().sum()) - moved * by_pair;
    for (Eigen::Index i = 0; i < n; ++i) slopes[static_cast<std::size_t>(i)] += slope(i);
  }

  std::vector<Comparison> comparisons;
  Eigen::Index items;
  bool prior;
};

/// Inverse on vectors that sum to 0: only distances are known.
Eigen::MatrixXd inverse_of_distances(const Eigen::MatrixXd& information) {
  const auto n = information.rows();
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Constant(n, n, 1.0 / static_cast<double>(n));
  return (information + ones).inverse() - ones;
}

/// Steps by Fisher's scoring, halved until they gain; the likelihood alone is concave.
bool maximise_scores(const ThurstoneModel& model, Eigen::VectorXd& scores) {
  ThurstoneModel::Value value = model.evaluate(scores);
  for (int i = 0; i < most_newton_steps; ++i) {
    Eigen::VectorXd step = inverse_of_distances(value.information) * value.gradient;
    if (!step.allFinite()) return false;
    if (value.gradient.dot(step) < 1e-13 * (1.0 + std::abs(value.objective))) return true;
    ThurstoneModel::Value next = model.evaluate(scores + step);
    for (int half = 0; half < 40 && !(next.objective > value.objective); ++half) {
      step *= 0.5;
      next = model.evaluate(scores + step);
    }
    if (!(next.objective > value.objective)) return true;  // no step gains what rounding can show
    scores += step;
    value = std::move(next);
    if (scores.cwiseAbs().maxCoeff() > most_jod) return false;
  }
  return false;
}

/// Scores of one participant's comparisons at the estimate, for the sandwich.
Eigen::VectorXd scores_of(const Table& wins, const std::vector<double>& jod) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(jod.size()));
  for (std::size_t a = 0; a < jod.size(); ++a) {
    for (std::size_t b = 0; b < jod.size(); ++b) {
      if (!(wins[a][b] > 0.0)) continue;
      const double slope = wins[a][b] * chance_at(jod[a] - jod[b]).win_slope;
      gradient(static_cast<Eigen::Index>(a)) += slope;
      gradient(static_cast<Eigen::Index>(b)) -= slope;
    }
  }
  return gradient;
}

std::vector<double> robust_errors(const std::vector<Ranking>& rankings,
                                  const std::vector<double>& jod) {
  std::map<std::size_t, std::vector<Ranking>> by_participant;
  for (const Ranking& ranking : rankings) by_participant[ranking.cluster].push_back(ranking);
  const auto n = static_cast<Eigen::Index>(jod.size());
  Eigen::MatrixXd filling = Eigen::MatrixXd::Zero(n, n);
  for (const auto& [participant, own] : by_participant) {
    const auto score = scores_of(wins_of(own, jod.size()), jod);
    filling += score * score.transpose();
  }
  const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(jod.data(), n);
  // The model counts every pair in both directions, the scores once.
  const Eigen::MatrixXd bread = inverse_of_distances(
      0.5 * ThurstoneModel(wins_of(rankings, jod.size()), false).evaluate(at).information);
  const Eigen::MatrixXd covariance = bread * filling * bread;
  std::vector<double> errors;
  for (Eigen::Index i = 0; i < n; ++i) errors.push_back(std::sqrt(std::max(0.0, covariance(i, i))));
  return errors;
}

}  // namespace

JodScale scale_jod(const Table& wins, bool prior) {
  JodScale scale;
  if (wins.size() < 2) {
    scale.reason = "fewer than two techniques";
    return scale;
  }
  std::vector<Ranking> comparisons;
  for (std::size_t i = 0; i < wins.size(); ++i) {
    for (std::size_t j = 0; j < wins.size(); ++j) {
      if (wins[i][j] > 0.0) comparisons.push_back({{{i}, {j}}, wins[i][j], 0});
    }
  }
  const Comparability comparable = comparability(comparisons, wins.size());
  if (comparable.groups.size() > 1) {
    scale.reason = not_connected;
    return scale;
  }
  Eigen::VectorXd scores = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(wins.size()));
  if ((!prior && !comparable.bounded) || !maximise_scores(ThurstoneModel(wins, prior), scores)) {
    scale.reason = "some techniques beat all others every time: their distance is unbounded";
    return scale;
  }
  scores.array() -= scores.mean();
  scale.scores.assign(scores.data(), scores.data() + scores.size());
  return scale;
}

json jod_json(const std::vector<Ranking>& rankings, const std::vector<std::string>& techniques) {
  const JodScale scale = scale_jod(wins_of(rankings, techniques.size()), true);
  json result = {{"scores", json::array()}};
  if (!scale.reason.empty()) return with_reason(std::move(result), scale.reason);
  const auto errors = robust_errors(rankings, scale.scores);
  const double reach = normal_quantile(0.975);
  for (std::size_t i = 0; i < techniques.size(); ++i) {
    const double half = reach * errors[i];
    result["scores"].push_back({{"technique", techniques[i]},
                                {"jod", scale.scores[i]},
                                {"robust_se", errors[i]},
                                {"ci95", {scale.scores[i] - half, scale.scores[i] + half}}});
  }
  return result;
}

}  // namespace penumbra::study::statistics
