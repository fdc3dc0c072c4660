// Claims whose true numbers are known in closed form, and what a verdict takes.
#include "experiments/claims/claim.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "experiments/claims/run.h"
#include "renderer/error.h"
#include "tests/jobs/temporary_folder.h"

namespace penumbra::experiments::claims {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json measure(const TemporaryFolder& folder, const std::vector<std::string>& only) {
  Options options;
  options.engine.folder = folder.path();
  options.engine.timing.run_ms = 1.0;
  options.only = only;
  options.quick = true;
  options.command = "penumbra claims";
  options.page = folder.path() / "claims.md";
  return run(options);
}

const json& claim_of(const json& summary, const std::string& id) {
  for (const json& claim : summary.at("claims"))
    if (claim.at("id") == id) return claim;
  throw std::logic_error("no claim " + id);
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Claims, of_published_tables_and_of_arithmetic_give_their_known_numbers) {
  const TemporaryFolder folder;
  const json summary = measure(folder, {"P03", "P05", "P07", "Q05", "Q43", "Q49"});
  EXPECT_TRUE(summary.at("device").is_null()) << "no picture is needed";
  // R: cor(method = "spearman") of tables 4.2 and 4.9, and of 4.2 and 4.3 to 4.8.
  EXPECT_NEAR(claim_of(summary, "P05").at("numbers").at("Spearman"), -0.2857143, 1e-7);
  EXPECT_NEAR(claim_of(summary, "P07").at("numbers").at("island"), -0.275, 5e-4);
  const json& means = claim_of(summary, "Q05").at("numbers");
  EXPECT_DOUBLE_EQ(means.at("mean depth"), 267.0 / 9.0);
  EXPECT_DOUBLE_EQ(means.at("mean of shadows"), 5.0 / 9.0);
  EXPECT_DOUBLE_EQ(means.at("shadow of the mean depth"), 0.0);
  EXPECT_EQ(claim_of(summary, "P03").at("verdict"), "reproduced");
  EXPECT_LT(claim_of(summary, "Q49").at("numbers").at("metres off, directional"), 1e-12);
  EXPECT_GT(claim_of(summary, "Q49").at("numbers").at("metres off, lamp"), 0.01);
  const json& tables = claim_of(summary, "Q43").at("numbers");
  EXPECT_DOUBLE_EQ(tables.at("law at 1024"), std::ldexp(1.0, 20 - 24) / 25.0);
  EXPECT_EQ(claim_of(summary, "P05").at("verdict"), "reproduced");
  EXPECT_EQ(claim_of(summary, "Q05").at("verdict"), "reproduced");
  EXPECT_THAT(text_of(folder.path() / "claims.md"), HasSubstr("| P05 | S0 tables 4.2, 4.9 |"));
  EXPECT_THAT(text_of(folder.path() / "results.csv"), HasSubstr("Spearman=-0.285714"));
}

/// Two moments of 16 bits and their mips against one depth of 32.
TEST(Claims, count_bytes_and_levels_and_go_on_where_they_were) {
  const TemporaryFolder folder;
  const json first = measure(folder, {"C24", "Q06"});
  const json& bytes = claim_of(first, "C24").at("numbers");
  EXPECT_EQ(bytes.at("bytes of the map"), 512 * 512 * 4);
  const json& levels = claim_of(first, "Q06").at("numbers");
  EXPECT_LE(levels.at("levels of 4 samples"), 5.0);
  EXPECT_GT(levels.at("levels of 4 samples"), 1.0);
  EXPECT_LE(levels.at("levels of 9 samples"), 10.0);
  EXPECT_GT(first.at("measured"), 0);
  const json again = measure(folder, {"C24", "Q06"});
  EXPECT_EQ(again.at("measured"), 0);
  EXPECT_EQ(again.at("claims"), first.at("claims"));
}

TEST(Claims, count_bytes_and_vertices_of_tiles_exactly) {
  const TemporaryFolder folder;
  const json summary = measure(folder, {"Q22", "C16", "C17"});
  EXPECT_EQ(claim_of(summary, "Q22").at("numbers").at("bytes of IASM"), 6860800);
  EXPECT_EQ(claim_of(summary, "Q22").at("numbers").at("bytes of CSM"), 12582912);
  const json& vertices = claim_of(summary, "C16").at("numbers");
  EXPECT_DOUBLE_EQ(vertices.at("ratio (16/3)"), 16.0 / 3.0);
  const json& casters = claim_of(summary, "C17").at("numbers");
  EXPECT_GE(casters.at("casters drawn, spheres"), casters.at("boxes"));
  EXPECT_GE(casters.at("boxes"), casters.at("that reach into tiles"));
  EXPECT_GT(casters.at("that reach into tiles"), 0);
}

TEST(Claims, count_what_is_submitted_and_what_leaks) {
  const TemporaryFolder folder;
  const json summary = measure(folder, {"C27", "Q03", "Q04"});
  const json& submitted = claim_of(summary, "C27").at("numbers");
  EXPECT_EQ(submitted.at("vertices with textures"), 3.0 * 1600.0);  // the aircraft and its apron
  EXPECT_EQ(submitted.at("vertices with a map"), 2.0 * 3.0 * 1600.0);
  const json& leaks = claim_of(summary, "Q03").at("numbers");
  EXPECT_LT(leaks.at("shadow-volumes, which find holes"), 0.02);
  EXPECT_LT(claim_of(summary, "Q04").at("numbers").at("by the triangle's plane"), 0.02);
}

TEST(Claims, no_choice_along_a_path_beats_the_best_of_its_kind) {
  const TemporaryFolder folder;
  const json summary = measure(folder, {"C14"});
  const json& regrets = claim_of(summary, "C14").at("numbers");
  const double scene = regrets.at("regret of the best a scene");
  EXPECT_GE(scene, 0.0);
  for (const char* arm : {"regret of one choice for all", "regret of recommend, a scene"})
    EXPECT_GE(regrets.at(arm).get<double>(), scene - 1e-12) << arm;
  EXPECT_GE(regrets.at("regret of recommend, a frame"), -1e-12);
}

TEST(Claims, are_judged_by_the_parts_of_their_rules) {
  EXPECT_EQ(verdict_of({true, true}), Verdict::reproduced);
  EXPECT_EQ(verdict_of({true, false}), Verdict::in_part);
  EXPECT_EQ(verdict_of({false, false}), Verdict::not_reproduced);
}

TEST(Claims, have_ids_of_their_own_and_wait_for_nothing_but_people) {
  std::set<std::string> ids;
  std::vector<std::string> waiting;
  for (const Claim& claim : all()) {
    EXPECT_TRUE(ids.insert(claim.id).second) << claim.id << " is there twice";
    EXPECT_FALSE(claim.source.empty() || claim.statement.empty() || claim.rule.empty()) << claim.id;
    EXPECT_EQ(claim.measure == nullptr, claim.needs == Needs::people) << claim.id;
    if (claim.measure == nullptr) waiting.push_back(claim.id);
  }
  // Numbered without a gap: none is forgotten.
  for (const auto& [letter, last] : {std::pair{'P', 12}, {'Q', 49}, {'C', 29}})
    for (int i = 1; i <= last; ++i) {
      const std::string id = letter + std::string(i < 10 ? "0" : "") + std::to_string(i);
      EXPECT_TRUE(ids.contains(id)) << id << " is missing";
    }
  EXPECT_EQ(ids.size(), 12u + 49u + 29u);
  const TemporaryFolder folder;
  const json summary = measure(folder, waiting);
  for (const std::string& id : waiting)
    EXPECT_EQ(claim_of(summary, id).at("verdict"), "needs people") << id;
}

TEST(Claims, that_there_are_not_are_refused_by_name) {
  const TemporaryFolder folder;
  try {
    measure(folder, {"P05", "X99"});
    FAIL() << "it was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.field, "only");
    EXPECT_THAT(error.what(), HasSubstr("X99"));
  }
}

}  // namespace
}  // namespace penumbra::experiments::claims
