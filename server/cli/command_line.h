#pragma once

namespace penumbra::server::cli {

/// Exit states of the program.
inline constexpr int done = 0;
inline constexpr int failed = 1;
inline constexpr int wrong_usage = 2;

/// Reads the command line, carries the command out and returns the exit state.
int run(int argc, const char* const* argv);

}  // namespace penumbra::server::cli
