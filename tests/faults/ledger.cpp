#include "tests/faults/ledger.h"

#include <gtest/gtest.h>
#include <sys/utsname.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iostream>
#include <thread>

namespace penumbra::faults {
namespace {

std::vector<Entry>& entries() {
  static std::vector<Entry> all;
  return all;
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%d %B %Y", std::gmtime(&now));
  return text;
}

std::string value_in(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(key)) return line.substr(line.find_first_not_of("\t :=", key.size()));
  return "unknown";
}

std::string machine() {
  utsname system{};
  ::uname(&system);
  const double gigabytes = std::stod("0" + value_in("/proc/meminfo", "MemTotal")) / 1048576.0;
  std::ostringstream text;
  text << value_in("/proc/cpuinfo", "model name") << ", "
       << std::max(1u, std::thread::hardware_concurrency()) << " cores, "
       << static_cast<int>(gigabytes + 0.5) << " GiB, Linux " << system.release;
  return text.str();
}

}  // namespace

Fault::Fault(int item_, const std::string& fault_) : item(item_), fault(fault_) {}

Fault::~Fault() {
  Entry entry{item,
              fault,
              did.str(),
              tries,
              lost,
              doubled,
              !testing::Test::HasFailure() && lost == 0 && doubled == 0};
  std::cout << (item > 0 ? std::to_string(item) + ". " : "") << fault << ": " << tries << " tries, "
            << lost << " lost, " << doubled << " doubled; " << entry.did << ": "
            << (entry.survived ? "survived" : "FAILED") << std::endl;
  entries().push_back(std::move(entry));
}

const std::vector<Entry>& ledger() {
  return entries();
}

std::size_t& most_resident() {
  static std::size_t bytes = 0;
  return bytes;
}

std::string page(const std::string& command) {
  auto rows = entries();
  std::stable_sort(rows.begin(), rows.end(), [](const Entry& a, const Entry& b) {
    return (a.item == 0 ? 1000 : a.item) < (b.item == 0 ? 1000 : b.item);
  });
  const auto survived =
      std::count_if(rows.begin(), rows.end(), [](const Entry& entry) { return entry.survived; });
  std::ostringstream text;
  text << "# What the service survives\n\n"
       << "Written by `" << command << "` on " << today() << " (" << machine() << "). Every row "
       << "drives the real `penumbra serve` from outside, as a process of its own. A try is one "
       << "fault; lost are acknowledged answers that were gone afterwards, doubled those that were "
       << "there twice.\n\n"
       << survived << " of " << rows.size() << " survived. The server's memory stayed under "
       << (most_resident() + (1 << 20) - 1) / (1 << 20) << " MiB throughout.\n\n"
       << "| | fault | tries | lost | doubled | what was seen | verdict |\n"
       << "|---|---|---|---|---|---|---|\n";
  for (const auto& row : rows)
    text << "| " << (row.item > 0 ? std::to_string(row.item) : "") << " | " << row.fault << " | "
         << row.tries << " | " << row.lost << " | " << row.doubled << " | " << row.did << " | "
         << (row.survived ? "survived" : "**failed**") << " |\n";
  return text.str();
}

}  // namespace penumbra::faults
