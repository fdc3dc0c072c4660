#include "experiments/engine/versions.h"

#include <map>

namespace penumbra::experiments {

const std::map<std::string, std::string>& technique_digests();  // write_folder_digests.cmake

std::string technique_version(const std::string& id) {
  return technique_digests().at("") + "-" + technique_digests().at(id);
}

}  // namespace penumbra::experiments
