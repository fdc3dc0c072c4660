#pragma once

#include <map>
#include <string>
#include <vector>

/// Published results of van Sambeek 2007, by the preset whose settings are his.
namespace penumbra::published {

/// His scenes in his order, by the built-in scene that stands for each.
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

/// Table 4.9: mean rank over all scenes, 1 most real, 9 least; the reference's own was 4.37.
inline const std::map<std::string, double> mean_rank{
    {"shadow-map", 6.60},     {"pcf-3x3", 5.47},
    {"pcf-bilinear", 5.73},   {"pcf-bilinear-3x3", 4.40},
    {"pcss-nearest", 4.85},   {"vsm-2007", 4.11},
    {"shadow-volumes", 6.12}, {"soft-shadow-volumes-2007", 4.34}};

}  // namespace penumbra::published
