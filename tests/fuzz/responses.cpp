// Answers as CSV, through the whole of the statistics.
#include "study/responses.h"

#include "study/statistics/report.h"
#include "tests/fuzz/target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace penumbra;
  fuzz::refuse_only_with({"unreadable", "bad_value"}, [&] {
    const auto rows = study::parse_responses(fuzz::text_of(data, size));
    const study::ReportOptions options;
    study::statistics_table(study::statistics_report(rows, options), options);
  });
  return 0;
}
