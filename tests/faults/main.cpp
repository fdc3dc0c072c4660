// Usage: penumbra_test_faults [--page FILE | --minutes N] [GTEST-OPTION]...
// Runs the suite; with --page it writes what it counted as a page. With --minutes, mixed traffic
// for so long instead.
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <set>
#include <string>

#include "tests/faults/ledger.h"
#include "tests/faults/traffic.h"

namespace {

constexpr int items = 49;  ///< of the list of faults

/// After the last test: no server of any of them took more memory than this.
class MemoryBound : public testing::Environment {
  void TearDown() override {
    constexpr std::size_t bound = 400u << 20;
    const auto most = penumbra::faults::most_resident();
    std::cout << "The server's memory stayed under " << (most >> 20) + 1 << " MiB throughout."
              << std::endl;
    EXPECT_LT(most, bound);
  }
};

/// Items that no test declared.
std::set<int> missing_items() {
  std::set<int> missing;
  for (int item = 1; item <= items; ++item) missing.insert(item);
  for (const auto& entry : penumbra::faults::ledger()) missing.erase(entry.item);
  return missing;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  std::string page;
  const std::string option = argc == 3 ? argv[1] : "";
  if (option == "--minutes") return penumbra::faults::run_traffic(std::stod(argv[2]));
  if (option == "--page") {
    page = argv[2];
  } else if (argc > 1) {
    std::cerr << "usage: penumbra_test_faults [--page FILE | --minutes N] [GTEST-OPTION]...\n";
    return 2;
  }
  testing::AddGlobalTestEnvironment(new MemoryBound);
  int status = RUN_ALL_TESTS();
  if (page.empty()) return status;
  for (const int item : missing_items()) {
    std::cerr << "no test of item " << item << '\n';
    status = 1;
  }
  std::ofstream(page) << penumbra::faults::page("tests/faults/run --page docs/reliability.md");
  return status;
}
