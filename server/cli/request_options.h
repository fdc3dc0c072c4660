#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "server/jobs/canonical_request.h"

namespace penumbra::server::cli {

/// The options that say what to draw. Values stay text until the request is read, by the same
/// function and with the same messages as for HTTP.
struct RequestOptions {
  std::string scene;
  std::string technique;
  std::vector<std::string> sets;            ///< name=value
  std::vector<std::string> lights;          ///< NAME.key=value
  std::vector<std::string> camera_sets;     ///< NAME.key=value
  std::filesystem::path camera_path;        ///< a JSON file, or empty
  std::map<std::string, std::string> keys;  ///< width, height, ...: those given
  std::filesystem::path data;
  std::string device;
  bool validation = false;

  void add_to(CLI::App& command);

  RequestContext context() const { return {data, device, true}; }

  /// Throws as read_request does.
  CanonicalRequest read(bool measure) const;
};

}  // namespace penumbra::server::cli
