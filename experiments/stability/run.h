#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/stability/search.h"

namespace penumbra::experiments::stability {

struct Options {
  std::vector<std::string> techniques;  ///< ids or presets; empty: every technique
  std::vector<std::string> axes;        ///< ids; empty: all
  std::filesystem::path out;            ///< folder of results, made if it is not there
  std::string device;                   ///< as RendererOptions has it
  std::string version;                  ///< of the program: results of others are drawn anew
  unsigned processes = 2;               ///< that draw at once
  double longest_step_s = 300.0;        ///< a step without an end is ended after it
  /// Gets values from 0 to 1 and what is being drawn.
  std::function<void(double, const std::string&)> progress;
};

struct Report {
  std::string device, driver, version;
  std::vector<std::string> techniques;
  std::vector<Finding> findings;  ///< technique by technique, axes in their order
  std::size_t steps = 0;          ///< in all findings
  std::size_t drawn = 0;          ///< of them in this run; the others were known
};

/// Pushes every technique along every axis. Whatever a driver does, this process goes on: pictures
/// are drawn in copies of it, which are ended and replaced. Throws not_found naming the technique
/// or axis that does not exist, and unwritable. No device may have been made in this process
/// before.
Report run(const Options& options);

}  // namespace penumbra::experiments::stability
