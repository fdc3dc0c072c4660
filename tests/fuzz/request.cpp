// Bodies of POST /api/v1/renders. A canonical request is read again as itself.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "server/jobs/canonical_request.h"
#include "tests/fuzz/target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace penumbra;
  const auto body = nlohmann::json::parse(fuzz::text_of(data, size), nullptr, false);
  if (body.is_discarded()) return 0;
  fuzz::refuse_only_with({"bad_value", "not_found", "unsupported"}, [&] {
    const auto request = server::read_request(body, {});
    nlohmann::json again = request.request;
    // What the server adds is no key of a body.
    for (const char* derived : {"renderer", "scene_hash", "device"}) again.erase(derived);
    if (server::read_request(again, {}).id != request.id) std::abort();
  });
  return 0;
}
