// Study documents: what is accepted is read again from its own document with the same hash.
#include "study/study.h"

#include <cstdlib>

#include "tests/fuzz/target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace penumbra;
  fuzz::refuse_only_with({"bad_value", "unreadable"}, [&] {
    const auto study = study::parse_study(fuzz::text_of(data, size));
    const auto again = study::parse_study(study.document.dump());
    if (study::study_hash(again) != study::study_hash(study)) std::abort();
    study::all_renders(study);
    study::welcome_document(study);
  });
  return 0;
}
