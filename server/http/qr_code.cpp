// The participant's address as a QR code, for posters and phones.
#include <qrencode.h>

#include <memory>

#include "server/http/reply.h"
#include "server/http/service.h"

namespace penumbra::server::http {
namespace {

/// Modules around the code that stay light (ISO/IEC 18004, 6.3.8).
constexpr int quiet_zone = 4;

/// Black modules as one path of unit squares on white.
std::string svg_of(const QRcode& code) {
  std::string path;
  for (int y = 0; y < code.width; ++y)
    for (int x = 0; x < code.width; ++x)
      if ((code.data[y * code.width + x] & 1) != 0)
        path += "M" + std::to_string(x + quiet_zone) + " " + std::to_string(y + quiet_zone) +
                "h1v1h-1z";
  const auto size = std::to_string(code.width + 2 * quiet_zone);
  return R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 )" + size + " " + size +
         R"(" shape-rendering="crispEdges"><path fill="#fff" d="M0 0h)" + size + "v" + size +
         "H0z" + R"("/><path d=")" + path + R"("/></svg>)" + "\n";
}

/// As participants reach this server: by its public address, or by the one it was called under.
std::string participant_address(const Call& call) {
  std::string base = call.service.options.public_url;
  if (base.empty()) base = "http://" + call.request.get_header_value("Host");
  while (base.ends_with('/')) base.pop_back();
  return base + "/s/" + call.path.at("id");
}

void get_qr_code(Call& call) {
  if (!call.service.studies.current(call.path.at("id"))) throw nothing_here();
  const std::unique_ptr<QRcode, decltype(&QRcode_free)> code(
      QRcode_encodeString8bit(participant_address(call).c_str(), 0, QR_ECLEVEL_M), QRcode_free);
  if (!code) throw bad_value("id", "the address is too long for a QR code");
  call.response.status = 200;
  call.response.set_content(svg_of(*code), "image/svg+xml");
}

}  // namespace

void add_qr_code_routes(std::vector<Route>& table) {
  table.push_back({"GET", "/api/v1/studies/{id}/qr.svg", Access::researcher, get_qr_code});
}

}  // namespace penumbra::server::http
