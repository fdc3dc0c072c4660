// Tables of van Sambeek 2007, as bench/ has them, and what follows from them.
#include <gtest/gtest.h>

#include <numeric>

#include "bench/van_sambeek_2007.h"
#include "study/statistics/agreement.h"

namespace penumbra::study::statistics {
namespace {

TEST(PublishedTables, hold_the_means_of_their_own_rows) {
  ASSERT_EQ(published::rms_y.size(), 8u);
  for (const auto& [technique, row] : published::rms_y) {
    ASSERT_EQ(row.size(), published::scenes.size());
    const double mean = std::accumulate(row.begin(), row.end(), 0.0) / 6.0;
    EXPECT_NEAR(published::mean_rms_y.at(technique), mean, 0.0011) << technique;
  }
}

/// R: cor(c(7.709, 7.349, 7.131, 7.238, 7.932, 8.267, 4.344, 4.368),
///        c(6.60, 5.47, 5.73, 4.40, 4.85, 4.11, 6.12, 4.34), method = "spearman")
TEST(PublishedTables, say_that_error_and_perceived_realism_disagree) {
  std::vector<double> errors, ranks;
  for (const auto& [technique, error] : published::mean_rms_y) {
    errors.push_back(error);
    ranks.push_back(published::mean_rank.at(technique));
  }
  EXPECT_NEAR(spearman(errors, ranks).value(), -0.2857143, 1e-7);
}

}  // namespace
}  // namespace penumbra::study::statistics
