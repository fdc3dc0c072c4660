#pragma once

namespace penumbra::faults {

/// Mixed traffic against a server of its own for so many minutes: people who take part and leave,
/// renders, exports, uploads, nonsense. Prints memory, descriptors and the database's log as they
/// go. Returns 0 where nothing grew and nothing failed.
int run_traffic(double minutes);

}  // namespace penumbra::faults
