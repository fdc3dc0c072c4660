// What the built program does with studies and answers.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "server/storage/data_folder.h"
#include "server/storage/studies.h"
#include "tests/cli/program.h"

namespace penumbra {
namespace {

using nlohmann::json;
using server::read_whole;
using testing::HasSubstr;

TEST_F(ProgramTest, analyses_answers) {
  std::ofstream csv(path("r.csv"));
  csv << "participant,scene,technique,rank_1_is_most_realistic,difficulty_1_hard_to_see_5_easy\n";
  for (int person = 0; person < 12; ++person)
    csv << person << ",s,good," << 1 << ",3\n"
        << person << ",s,bad," << (person == 0 ? 1 : 2) << ",3\n";
  csv.close();
  const Outcome outcome = run("statistics r.csv --out results --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json scene = json::parse(outcome.out).at("included_sets").at("all").at("scenes").at(0);
  EXPECT_EQ(scene.at("techniques").at(0).at("technique"), "good");
  EXPECT_TRUE(std::filesystem::exists(path("results/results.json")));
}

TEST_F(ProgramTest, reads_what_spreadsheets_write_and_says_so) {
  std::ofstream csv(path("r.csv"));
  csv << "participant;scene;technique;rank_1_is_most_realistic;difficulty_1_hard_to_see_5_easy\n";
  for (int person = 0; person < 4; ++person)
    csv << person << ";s;PCF 3\xC3\x97"
        << "3;1,5;3\n"
        << person << ";s;weich;1,5;3\n";
  csv.close();
  const Outcome found = run("statistics r.csv --json");
  ASSERT_EQ(found.status, 0) << found.err;
  EXPECT_THAT(json::parse(found.out).at("notes").dump(), HasSubstr("semicolons"));
  EXPECT_EQ(run("statistics r.csv --separator semicolon").status, 0);
  const Outcome wrong = run("statistics r.csv --separator tab");
  EXPECT_EQ(wrong.status, 1);
  EXPECT_THAT(wrong.err, HasSubstr("separated by tabs it holds `participant;scene;technique"));
}

TEST_F(ProgramTest, backs_up_verifies_restores_and_exports) {
  {
    namespace storage = server::storage;
    const storage::DataFolder owned(path("store"));
    storage::Database database(path("store/penumbra.sqlite"));
    storage::Studies studies(database);
    const auto document =
        json::parse(*read_whole(std::string(PENUMBRA_SOURCE_DIR) + "/studies/thesis-2007.json"));
    studies.put_draft("thesis-2007", document, 7, "2026-01-01");
    studies.start_publishing("thesis-2007", 1, "hash", 0);
    studies.open("thesis-2007", 1, "2026-01-01");
  }
  EXPECT_EQ(run("verify --data store").status, 0);
  ASSERT_EQ(run("backup --data store --out backup.zip --json").status, 0);
  EXPECT_EQ(run("verify --data backup.zip").status, 0);
  ASSERT_EQ(run("restore backup.zip --data again").status, 0);
  EXPECT_EQ(run("verify --data again").status, 0);
  const Outcome exported = run("export thesis-2007 --data again --out export.zip --json");
  ASSERT_EQ(exported.status, 0) << exported.err;
  EXPECT_GT(json::parse(exported.out).at("bytes").get<int>(), 1000);
  EXPECT_EQ(run("export nothing --data again --out other.zip").status, 2);

  std::filesystem::remove(path("again/integrity.key"));
  const Outcome damaged = run("verify --data again --json");
  EXPECT_EQ(damaged.status, 1);
  EXPECT_FALSE(json::parse(damaged.out).at("sound").get<bool>());
  EXPECT_EQ(run("backup --data again --out other.zip").status, 1);
  EXPECT_EQ(run("verify --data nowhere").status, 2);
}

}  // namespace
}  // namespace penumbra
