#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "requests/fields.h"
#include "server/jobs/canonical_request.h"

namespace penumbra::server::cli {

/// The options that say what to draw, one for each field of a request. Values stay text until the
/// request is read, by the same function and with the same messages as for HTTP.
struct RequestOptions {
  std::map<std::string, std::string> texts;  ///< of fields with one value: those given
  /// Of fields with several values: name=value, as given.
  std::map<std::string, std::vector<std::string>> lists;
  std::filesystem::path data;
  std::string device;
  bool validation = false;

  /// `which`: the command, where it has options that others lack.
  void add_to(CLI::App& command, requests::Commands which = requests::Commands::all);

  /// Value of a field; empty where none was given.
  std::string text(const std::string& field) const;

  RequestContext context() const { return {data, device, true}; }

  /// Throws as read_request does.
  CanonicalRequest read(bool measure) const;
};

}  // namespace penumbra::server::cli
