#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

/// Published results of van Sambeek 2007, by the preset whose settings are his.
namespace penumbra::published {

/// His scenes in his order, by the built-in scene that rebuilds each.
inline const std::vector<std::string> scenes{
    "car", "boxes", "disco-box", "island", "warehouse-inside", "warehouse-outside"};

/// Table 4.2: rms_y of pictures of 600x600 with maps of 512x512, against 1024 random light points.
inline const std::map<std::string, std::vector<double>> rms_y{
    {"shadow-map", {7.739, 7.790, 4.371, 13.728, 4.282, 8.342}},
    {"pcf-3x3", {7.370, 6.327, 3.610, 14.711, 3.933, 8.145}},
    {"pcf-bilinear", {7.517, 7.078, 3.658, 12.169, 4.118, 8.246}},
    {"pcf-bilinear-3x3", {7.303, 6.132, 3.477, 14.507, 3.884, 8.125}},
    {"pcss-nearest", {5.400, 6.982, 3.797, 21.356, 1.862, 8.195}},
    {"vsm-2007", {7.370, 8.433, 4.667, 17.481, 4.007, 7.644}},
    {"shadow-volumes", {6.954, 6.192, 3.860, 1.587, 4.807, 2.662}},
    {"soft-shadow-volumes-2007", {5.698, 5.557, 1.888, 4.276, 4.395, 4.394}}};

/// Table 4.2, column Avg.
inline const std::map<std::string, double> mean_rms_y{
    {"shadow-map", 7.709},     {"pcf-3x3", 7.349},
    {"pcf-bilinear", 7.131},   {"pcf-bilinear-3x3", 7.238},
    {"pcss-nearest", 7.932},   {"vsm-2007", 8.267},
    {"shadow-volumes", 4.344}, {"soft-shadow-volumes-2007", 4.368}};

/// A row of tables 4.3 to 4.9: a technique's weighted mean of the digits that people typed, 1 most
/// real, and the first and last of the table's subsets that it is in.
struct RankingRow {
  std::string technique;
  double mean = 0.0;
  int first_subset = 1;
  int last_subset = 1;
};

struct RankingTable {
  std::string name;
  std::string scene;             ///< empty: all scenes
  std::vector<RankingRow> rows;  ///< in his order
};

/// Table 4.8's second and third columns are run together in print; its members are read from how
/// often a number is printed, and in his text.
inline const std::vector<RankingTable> ranking_tables{{"4.3",
                                                       "car",
                                                       {{"soft-shadow-volumes-2007", 4.09, 1, 1},
                                                        {"vsm-2007", 4.16, 1, 1},
                                                        {"pcf-bilinear-3x3", 4.53, 1, 2},
                                                        {"pcss-nearest", 4.74, 1, 2},
                                                        {"pcf-3x3", 4.74, 1, 2},
                                                        {"pcf-bilinear", 5.02, 2, 3},
                                                        {"reference", 5.30, 2, 3},
                                                        {"shadow-volumes", 5.62, 3, 3},
                                                        {"shadow-map", 5.79, 3, 3}}},
                                                      {"4.4",
                                                       "boxes",
                                                       {{"reference", 3.49, 1, 1},
                                                        {"vsm-2007", 4.05, 1, 2},
                                                        {"pcf-bilinear-3x3", 4.11, 1, 2},
                                                        {"soft-shadow-volumes-2007", 4.75, 2, 3},
                                                        {"pcf-3x3", 4.91, 3, 3},
                                                        {"pcss-nearest", 4.96, 3, 3},
                                                        {"pcf-bilinear", 5.34, 3, 3},
                                                        {"shadow-volumes", 6.41, 4, 4},
                                                        {"shadow-map", 6.72, 4, 4}}},
                                                      {"4.5",
                                                       "disco-box",
                                                       {{"soft-shadow-volumes-2007", 3.35, 1, 1},
                                                        {"reference", 3.43, 1, 1},
                                                        {"vsm-2007", 3.74, 1, 1},
                                                        {"pcf-bilinear-3x3", 4.79, 2, 2},
                                                        {"pcss-nearest", 5.05, 2, 2},
                                                        {"pcf-3x3", 6.21, 3, 3},
                                                        {"shadow-volumes", 6.27, 3, 4},
                                                        {"pcf-bilinear", 6.65, 4, 4},
                                                        {"shadow-map", 7.35, 5, 5}}},
                                                      {"4.6",
                                                       "island",
                                                       {{"vsm-2007", 3.35, 1, 1},
                                                        {"pcf-bilinear-3x3", 3.44, 1, 1},
                                                        {"soft-shadow-volumes-2007", 4.89, 2, 2},
                                                        {"pcss-nearest", 5.18, 2, 3},
                                                        {"reference", 5.26, 2, 3},
                                                        {"shadow-volumes", 5.83, 3, 4},
                                                        {"pcf-3x3", 6.08, 4, 4},
                                                        {"pcf-bilinear", 6.08, 4, 4},
                                                        {"shadow-map", 7.18, 5, 5}}},
                                                      {"4.7",
                                                       "warehouse-inside",
                                                       {{"soft-shadow-volumes-2007", 4.22, 1, 1},
                                                        {"pcss-nearest", 4.23, 1, 1},
                                                        {"reference", 4.28, 1, 1},
                                                        {"pcf-bilinear-3x3", 4.86, 1, 2},
                                                        {"vsm-2007", 5.00, 1, 2},
                                                        {"pcf-3x3", 5.11, 1, 2},
                                                        {"pcf-bilinear", 5.41, 2, 2},
                                                        {"shadow-map", 6.51, 3, 3},
                                                        {"shadow-volumes", 6.84, 3, 3}}},
                                                      {"4.8",
                                                       "warehouse-outside",
                                                       {{"reference", 3.95, 1, 1},
                                                        {"soft-shadow-volumes-2007", 4.39, 1, 2},
                                                        {"pcss-nearest", 4.87, 2, 3},
                                                        {"pcf-bilinear-3x3", 4.96, 2, 3},
                                                        {"vsm-2007", 5.19, 2, 3},
                                                        {"pcf-bilinear", 5.25, 2, 3},
                                                        {"shadow-volumes", 5.25, 3, 3},
                                                        {"shadow-map", 5.36, 3, 3},
                                                        {"pcf-3x3", 5.53, 3, 3}}},
                                                      {"4.9",
                                                       "",
                                                       {{"vsm-2007", 4.11, 1, 1},
                                                        {"soft-shadow-volumes-2007", 4.34, 1, 2},
                                                        {"reference", 4.37, 1, 2},
                                                        {"pcf-bilinear-3x3", 4.40, 2, 2},
                                                        {"pcss-nearest", 4.85, 3, 3},
                                                        {"pcf-3x3", 5.47, 4, 4},
                                                        {"pcf-bilinear", 5.73, 5, 5},
                                                        {"shadow-volumes", 6.12, 6, 6},
                                                        {"shadow-map", 6.60, 7, 7}}}};

/// The row of a technique in a table.
inline const RankingRow& ranking_of(const RankingTable& table, const std::string& technique) {
  return *std::find_if(table.rows.begin(), table.rows.end(),
                       [&](const RankingRow& row) { return row.technique == technique; });
}

}  // namespace penumbra::published
