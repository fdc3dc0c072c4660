// Queries of GET /api/v1/image as names and values: lines of NAME=VALUE.
#include <sstream>

#include "requests/reader.h"
#include "server/jobs/canonical_request.h"
#include "tests/fuzz/target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace penumbra;
  std::vector<std::pair<std::string, std::string>> entries;
  std::istringstream lines(fuzz::text_of(data, size));
  for (std::string line; std::getline(lines, line);) {
    const auto equals = line.find('=');
    if (equals == std::string::npos) continue;
    entries.emplace_back(line.substr(0, equals), line.substr(equals + 1));
  }
  fuzz::refuse_only_with({"bad_value", "not_found", "unsupported"},
                         [&] { server::read_request(requests::request_from_text(entries), {}); });
  return 0;
}
