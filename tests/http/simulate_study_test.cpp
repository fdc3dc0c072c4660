// The program's simulated people against the real HTTP interface.
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "study/responses.h"
#include "tests/http/a_study.h"

namespace penumbra::server::http {
namespace {

class SimulatedPeople : public AStudy {
 protected:
  /// Exit state of `penumbra simulate-study` for the study that ships.
  int simulate(const std::string& arguments) {
    const auto file = (folder.path / "study.json").string();
    std::ofstream(file) << study()["document"].dump();
    const auto url = "http://127.0.0.1:" + std::to_string(server->port());
    const auto command = std::string(PENUMBRA_BINARY_DIR) + "/penumbra simulate-study " + file +
                         " --url '" + url + "' " + arguments + " > /dev/null 2>&1";
    return WEXITSTATUS(std::system(command.c_str()));
  }

  std::string token() { return " --token-file " + (options.data / "researcher.token").string(); }
};

TEST_F(SimulatedPeople, TakePartAsTheyAreToldToAndAreFoundOut) {
  ASSERT_EQ(simulate("--participants 30 --inverted 3 --step 1.5 --seed 4" + token()), 0);
  const auto counts = study()["participants"];
  EXPECT_EQ(counts["entered"], 30);
  EXPECT_EQ(counts["completed"], 30);
  const auto results = body_of(researcher->Get(at + "/results.json"), 200, "Results");
  int inverted = 0;
  int reference_last = 0;
  for (const auto& flag : results["flags"]) {
    if (flag["flag"] != "inverted") continue;
    ++inverted;
    EXPECT_EQ(flag["evidence"]["pages"], 6);
    reference_last += flag["evidence"]["reference_last"].get<int>();
    EXPECT_EQ(flag["evidence"]["turned_round"], 0);
  }
  EXPECT_EQ(inverted, 3);
  // The reference is last in the document, so that it is worth most: read backwards, it comes last
  // on a page with probability 1 - exp(-1.5). On 5 or fewer of 18 pages: once in a million runs.
  EXPECT_GE(reference_last, 6);
  // Worths rise with the document's order, so mean ranks fall: over all nine pictures of all pages,
  // which only holds where answers went to the slots of the pictures they are about.
  const auto& overall = results["included_sets"]["inverted_turned"]["overall"]["techniques"];
  const auto document = study()["document"];
  ASSERT_EQ(overall.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    const auto& entry = document["techniques"][8 - i];
    EXPECT_EQ(overall[i]["technique"], entry["technique"]) << i;
  }
}

TEST_F(SimulatedPeople, NeedTheTokenAndAServer) {
  EXPECT_EQ(simulate("--participants 1"), 1);
  EXPECT_EQ(study()["status"], "draft");
  EXPECT_EQ(simulate("--participants 3 --inverted 4" + token()), 2);
}

}  // namespace
}  // namespace penumbra::server::http
