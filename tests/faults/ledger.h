#pragma once

#include <chrono>
#include <sstream>
#include <string>
#include <vector>

/// What the suite did and counted. A test declares its Fault first and fills it as it goes; the
/// verdict is the test's. `penumbra_test_faults --page FILE` writes them all as a page.
namespace penumbra::faults {

/// Rows of the page, in order: the numbered list of faults, then what a trial found beyond it.
struct Entry {
  int item = 0;  ///< of the list; 0: beyond it
  std::string fault;
  std::string did;  ///< what was counted besides, in words
  int tries = 0;
  int lost = 0;     ///< acknowledged and gone
  int doubled = 0;  ///< there more than once
  bool survived = false;
};

class Fault {
 public:
  Fault(int item, const std::string& fault);
  /// Prints the line and puts it into the ledger, with the running test's verdict.
  ~Fault();
  Fault(const Fault&) = delete;
  Fault& operator=(const Fault&) = delete;

  int tries = 0;
  int lost = 0;
  int doubled = 0;
  std::ostringstream did;

 private:
  int item;
  std::string fault;
};

const std::vector<Entry>& ledger();

/// Most memory that any server of the suite used, bytes; those that tests of memory in workers or
/// sanitizers swell are not among them.
std::size_t& most_resident();

/// The page: date, machine, command, and a row per fault.
std::string page(const std::string& command);

}  // namespace penumbra::faults
