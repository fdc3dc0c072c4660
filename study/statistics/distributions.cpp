#include "study/statistics/distributions.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>

namespace penumbra::study::statistics {

namespace bm = boost::math;

double chi_square_tail(double x, double df) {
  return bm::cdf(bm::complement(bm::chi_squared(df), std::max(x, 0.0)));
}

std::array<double, 2> clopper_pearson(double successes, double n) {
  return {successes > 0.0 ? bm::ibeta_inv(successes, n - successes + 1.0, 0.025) : 0.0,
          successes < n ? bm::ibeta_inv(successes + 1.0, n - successes, 0.975) : 1.0};
}

double f_tail(double x, double df1, double df2) {
  if (std::isinf(x)) return 0.0;
  return bm::cdf(bm::complement(bm::fisher_f(df1, df2), std::max(x, 0.0)));
}

double normal_tail(double x) {
  return bm::cdf(bm::complement(bm::normal(), x));
}

double normal_quantile(double p) {
  return bm::quantile(bm::normal(), p);
}

double t_two_sided(double t, double df) {
  if (std::isinf(t)) return 0.0;
  return 2.0 * bm::cdf(bm::complement(bm::students_t(df), std::abs(t)));
}

double t_quantile(double p, double df) {
  return bm::quantile(bm::students_t(df), p);
}

std::array<double, 2> noncentrality_interval(double t, double df) {
  const double half = normal_quantile(0.975) * std::sqrt(1.0 + t * t / (2.0 * df));
  if (df > 200.0 || std::abs(t) > 30.0) return {t - half, t + half};
  // The distribution function falls as the noncentrality grows.
  const auto end = [&](double p) {
    const auto excess = [&](double delta) { return bm::cdf(bm::non_central_t(df, delta), t) - p; };
    double low = t - 3.0 * half - 3.0;
    double high = t + 3.0 * half + 3.0;
    std::uintmax_t iterations = 200;
    const auto bracket = bm::tools::toms748_solve(excess, low, high,
                                                  bm::tools::eps_tolerance<double>(40), iterations);
    return 0.5 * (bracket.first + bracket.second);
  };
  return {end(0.975), end(0.025)};
}

double studentized_range_tail(double q, int k) {
  if (q <= 0.0) return 1.0;
  // The integrand is analytic and falls like a Gaussian on both sides, so the trapezium rule
  // converges faster than any power of the step; all of its terms are positive.
  constexpr double step = 1.0 / 32.0;
  constexpr double reach = 12.0;
  const bm::normal normal;
  const int steps = static_cast<int>((q + 2.0 * reach) / step);
  double sum = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double z = -reach + step * i;
    const double below = bm::cdf(normal, z);
    const double share = std::min(1.0, bm::cdf(normal, z - q) / below);
    // Phi^(k-1) - (Phi - Phi(z-q))^(k-1) = Phi^(k-1) (1 - (1 - share)^(k-1))
    const double brace = share < 1.0 ? -std::expm1((k - 1) * std::log1p(-share)) : 1.0;
    sum += bm::pdf(normal, z) * std::pow(below, k - 1) * brace;
  }
  return std::min(1.0, k * step * sum);
}

double studentized_range_quantile(double p, int k) {
  const auto excess = [&](double q) { return studentized_range_tail(q, k) - p; };
  std::uintmax_t iterations = 200;
  const auto bracket =
      bm::tools::toms748_solve(excess, 0.0, 60.0, bm::tools::eps_tolerance<double>(50), iterations);
  return 0.5 * (bracket.first + bracket.second);
}

}  // namespace penumbra::study::statistics
