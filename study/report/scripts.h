#pragma once

#include <span>

#include "renderer/embedded_file.h"

namespace penumbra::study {

/// Files of study/report that the program carries: the style of reports, and the scripts that
/// recompute the headline numbers from responses.csv.
std::span<const EmbeddedFile> report_files();

}  // namespace penumbra::study
