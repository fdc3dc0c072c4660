// Tables of van Sambeek 2007, as study/ has them, and what follows from them.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "study/statistics/agreement.h"
#include "study/van_sambeek_2007.h"

namespace penumbra::study::statistics {
namespace {

const published::RankingTable& all_scenes() {
  return published::ranking_tables.back();
}

TEST(PublishedTables, hold_the_means_of_their_own_rows) {
  ASSERT_EQ(published::rms_y.size(), 8u);
  for (const auto& [technique, row] : published::rms_y) {
    ASSERT_EQ(row.size(), published::scenes.size());
    const double mean = std::accumulate(row.begin(), row.end(), 0.0) / 6.0;
    EXPECT_NEAR(published::mean_rms_y.at(technique), mean, 0.0011) << technique;
  }
}

/// Mid-ranks of nine pictures sum to 45. His do not: he averaged the digits that people typed.
TEST(PublishedTables, are_means_of_digits_and_not_of_ranks) {
  const std::vector<double> sums{43.99, 44.74, 46.84, 47.29, 46.46, 44.75, 45.99};
  ASSERT_EQ(published::ranking_tables.size(), sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const auto& table = published::ranking_tables[i];
    ASSERT_EQ(table.rows.size(), 9u);
    double sum = 0.0;
    double last = 0.0;
    for (const auto& row : table.rows) {
      sum += row.mean;
      EXPECT_GE(row.mean, last) << table.name << " stands in order";
      EXPECT_LE(row.first_subset, row.last_subset);
      last = row.mean;
    }
    EXPECT_NEAR(sum, sums[i], 1e-9) << table.name;
  }
}

/// P05. R: cor(c(7.709, 7.349, 7.131, 7.238, 7.932, 8.267, 4.344, 4.368),
///             c(6.60, 5.47, 5.73, 4.40, 4.85, 4.11, 6.12, 4.34), method = "spearman")
TEST(PublishedTables, say_that_error_and_perceived_realism_disagree) {
  std::vector<double> errors, ranks;
  for (const auto& [technique, error] : published::mean_rms_y) {
    errors.push_back(error);
    ranks.push_back(published::ranking_of(all_scenes(), technique).mean);
  }
  EXPECT_NEAR(spearman(errors, ranks).value(), -0.2857143, 1e-7);
}

/// P07. Within scenes they agree weakly; only the mean of errors, ruled by the island, turns the
/// sign. The six values are R's cor(method = "spearman") of tables 4.2 and 4.3 to 4.8.
TEST(PublishedTables, say_that_they_agree_weakly_within_scenes) {
  const std::vector<double> expected{0.464, 0.167, 0.381, -0.275, 0.476, 0.383};
  std::vector<RankedList> scenes;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto& table = published::ranking_tables[i];
    ASSERT_EQ(table.scene, published::scenes[i]);
    RankedList list;
    for (const auto& [technique, row] : published::rms_y) {
      list.a.push_back(row[i]);
      list.b.push_back(published::ranking_of(table, technique).mean);
    }
    EXPECT_NEAR(correlate_within({list}).rho.value(), expected[i], 0.0005) << table.name;
    EXPECT_EQ(correlate_within({list}).rho, spearman(list.a, list.b));
    scenes.push_back(list);
  }
  // Scenes of eight techniques, almost without ties: pooled within scenes is close to the mean.
  EXPECT_NEAR(correlate_within(scenes).rho.value(),
              std::accumulate(expected.begin(), expected.end(), 0.0) / 6.0, 0.003);
}

/// P02, P08: the reference is first in two scenes and among the best in four.
TEST(PublishedTables, put_the_reference_first_in_two_scenes_only) {
  std::vector<std::size_t> first, best;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& table = published::ranking_tables[i];
    if (table.rows.front().technique == "reference") first.push_back(i + 1);
    if (published::ranking_of(table, "reference").first_subset == 1) best.push_back(i + 1);
  }
  EXPECT_EQ(first, (std::vector<std::size_t>{2, 6}));
  EXPECT_EQ(best, (std::vector<std::size_t>{2, 3, 5, 6}));
}

/// P09: hard shadows are last in five scenes of six.
TEST(PublishedTables, put_hard_shadows_last_in_five_scenes) {
  int hard = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string& last = published::ranking_tables[i].rows.back().technique;
    hard += last == "shadow-map" || last == "shadow-volumes" ? 1 : 0;
    if (i == 5) {
      EXPECT_EQ(last, "pcf-3x3");
    }
  }
  EXPECT_EQ(hard, 5);
}

/// P10: his conclusion names PCSS; his own table puts 3x3 bilinear PCF before it, in an earlier
/// subset that PCSS is not in.
TEST(PublishedTables, put_filtered_maps_before_the_one_that_the_conclusion_names) {
  const auto& filtered = published::ranking_of(all_scenes(), "pcf-bilinear-3x3");
  const auto& named = published::ranking_of(all_scenes(), "pcss-nearest");
  EXPECT_LT(filtered.mean, named.mean);
  EXPECT_LT(filtered.last_subset, named.first_subset);
}

/// P11: in scene 4, whose light makes hard shadows, two soft techniques come before the reference
/// and share no subset with it.
TEST(PublishedTables, put_soft_shadows_before_the_reference_where_the_light_is_hard) {
  const auto& island = published::ranking_tables[3];
  const auto& reference = published::ranking_of(island, "reference");
  for (const char* soft : {"vsm-2007", "pcf-bilinear-3x3"}) {
    EXPECT_LT(published::ranking_of(island, soft).last_subset, reference.first_subset) << soft;
  }
}

}  // namespace
}  // namespace penumbra::study::statistics
