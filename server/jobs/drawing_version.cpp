#include "server/jobs/drawing_version.h"

#include "renderer/render.h"

namespace penumbra::server {

const char* drawing_digest();  // generated: cmake/write_digest.cmake

std::string drawing_version() {
  return std::string(renderer_version()) + "+" + drawing_digest();
}

}  // namespace penumbra::server
