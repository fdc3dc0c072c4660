#pragma once

#include <filesystem>

#include "experiments/stability/run.h"

namespace penumbra::experiments::stability {

/// Why something breaks, by technique and axis, and whether mathematics or the method requires it.
struct Reason {
  std::string technique;  ///< an id; one that ends in * means all that begin so
  std::string axis;
  bool required = false;
  std::string why;
};

/// The known reasons, from experiments/stability/reasons.json. Throws unreadable.
const std::vector<Reason>& reasons();

/// The first that fits, or null.
const Reason* reason_of(const std::string& technique, const std::string& axis);

/// Writes results.csv, steps.csv, safe-ranges.md, figures/*.svg and report.html, which opens by
/// itself offline. Throws unwritable.
void write_report(const Report& report, const std::filesystem::path& folder);

/// Lines of results.csv: technique, axis, value up to which it holds, value that ends it.
std::string findings_csv(const Report& report);

/// How far along its axis a finding holds, 0..1.
double share_held(const Finding& finding, const Axis& axis);

/// The axis of that id among the scene's or those of the technique's parameters. Throws
/// std::logic_error.
Axis find_axis(const std::string& technique, const std::string& id);

}  // namespace penumbra::experiments::stability
