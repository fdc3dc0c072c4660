// Claims that wait for people.
#include "experiments/claims/claim.h"

namespace penumbra::experiments::claims {
namespace {

Claim of_people(const char* id, const char* source, const char* statement, const char* rule) {
  return {id, source, statement, rule, nullptr, Needs::people};
}

}  // namespace

std::vector<Claim> waiting_claims() {
  return {
      of_people("P01", "S0 5.3", "soft borders rank as more real than hard ones",
                "from a study that holds both"),
      of_people("P02", "S0 table 4.3", "the reference is not always ranked best",
                "its mean rank with its interval, from a study"),
      of_people("P12", "S0 6.3", "9 = best is read right more often than 1 = best",
                "three arms of a study: digits either way, and shelves"),
  };
}

}  // namespace penumbra::experiments::claims
