#pragma once

#include <array>

namespace penumbra::study::statistics {

/// Upper tails: P(X > x).
double chi_square_tail(double x, double df);
double f_tail(double x, double df1, double df2);  ///< 0 for infinite x
double normal_tail(double x);
double normal_quantile(double p);  ///< P(X <= q) = p, 0 < p < 1

/// 95 % interval of a probability after `successes` of `n` (Clopper and Pearson 1934); halves count
/// as such.
std::array<double, 2> clopper_pearson(double successes, double n);

/// P(|T| > |t|), Student's t.
double t_two_sided(double t, double df);

/// Quantile of Student's t: P(T <= q) = p.
double t_quantile(double p, double df);

/// 95 % interval of the noncentrality that makes `t` likely: P(T >= t) = 0.025 at its lower end,
/// P(T <= t) = 0.025 at its upper one. Beyond 200 degrees of freedom or |t| > 30 by the normal
/// approximation t +- 1.96 sqrt(1 + t^2 / (2 df)).
std::array<double, 2> noncentrality_interval(double t, double df);

/// P(Q > q) of the studentized range of `k` standard normals at infinite degrees of freedom:
/// k * integral of phi(z) {Phi(z)^(k-1) - [Phi(z) - Phi(z-q)]^(k-1)} dz, without cancellation.
double studentized_range_tail(double q, int k);

/// q with P(Q > q) = p, 0 < p < 1.
double studentized_range_quantile(double p, int k);

}  // namespace penumbra::study::statistics
