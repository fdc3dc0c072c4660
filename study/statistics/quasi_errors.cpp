#include "study/statistics/quasi_errors.h"

#include <Eigen/Dense>
#include <cmath>

namespace penumbra::study::statistics {

std::vector<double> quasi_errors(const std::vector<std::vector<double>>& covariance) {
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
