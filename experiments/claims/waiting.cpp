// Claims that wait: for people, or for layouts of maps.
#include "experiments/claims/claim.h"

namespace penumbra::experiments::claims {
namespace {

using Names = std::vector<std::string>;

Claim of_people(const char* id, const char* source, const char* statement, const char* rule) {
  return {id, source, statement, rule, nullptr, Needs::people, {}};
}

Claim of_layouts(const char* id, const char* source, const char* statement, const char* rule,
                 const Names& layouts) {
  return {id, source, statement, rule, nullptr, Needs::nothing, layouts};
}

}  // namespace

std::vector<Claim> waiting_claims() {
  const Names tiles{"iasm"}, tiles_and_cascades{"iasm", "cascaded"};
  const Names late{"iasm-delayed", "cascaded"};
  return {
      of_people("P01", "S0 5.3", "soft borders rank as more real than hard ones",
                "from a study that holds both"),
      of_people("P02", "S0 table 4.3", "the reference is not always ranked best",
                "its mean rank with its interval, from a study"),
      of_people("P12", "S0 6.3", "9 = best is read right more often than 1 = best",
                "three arms of a study: digits either way, and shelves"),
      of_layouts("Q22", "S1 4.2", "IASM is close to CSM in 6,860,800 against 12,582,912 bytes",
                 "errors to exact hard shadows; bytes exactly", tiles_and_cascades),
      of_layouts("Q23", "S1 fig. 4.4", "IASM shows borders of tiles near the camera, CSM none",
                 "worst against median error over the camera's turn", tiles_and_cascades),
      of_layouts("Q44", "S1 5", "freely chosen sizes of tiles bring acne and flicker",
                 "change between frames, and false_shadow", tiles),
      of_layouts("Q48", "S1 fig. 4.5", "tight ranges of tiles beat CSM close to the camera",
                 "error near the camera at 16 bits", tiles_and_cascades),
      of_layouts("C09", "S1 table 4.1", "IASM is cheaper than CSM on trees, dearer on one mesh",
                 "ratio of the maps' passes", tiles_and_cascades),
      of_layouts("C10", "S1 table 4.1", "delayed read-back removes most of the stall",
                 "frame times with and without", {"iasm", "iasm-delayed"}),
      of_layouts("C15", "S1 table 4.1", "delayed IASM costs 1.05 of CSM on trees, 2.9 on the mesh",
                 "ratio of frames", late),
      of_layouts("C16", "S1 table 4.1", "on one mesh IASM draws 16/3 of CSM's vertices",
                 "vertices counted, exactly", tiles_and_cascades),
      of_layouts("C17", "S1 4.3", "bounding spheres draw tiles that boxes leave empty",
                 "instances drawn: spheres, boxes, exact", tiles),
      of_layouts("C29", "S1 table 4.1", "forward IASM reads back less than deferred",
                 "bytes copied", tiles),
  };
}

}  // namespace penumbra::experiments::claims
