#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace penumbra::bench {

/// The main function of a measurement: `add_options` declares what it takes, `measure` prints its
/// table. Returns the exit status; errors go to standard error.
inline int run_program(int count, char** values, const std::string& meaning,
                       const std::function<void(CLI::App&)>& add_options,
                       const std::function<void()>& measure) {
  CLI::App app(meaning);
  app.option_defaults()->always_capture_default();
  add_options(app);
  CLI11_PARSE(app, count, values);
  try {
    measure();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", values[0], error.what());
    return 1;
  }
}

/// The upper one of an even count.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// The edge of the pictures that are drawn.
inline void add_size_option(CLI::App& app, std::uint32_t& size) {
  app.add_option("--size", size, "Pixels, width and height")->check(CLI::PositiveNumber);
}

/// Which of the Vulkan devices to measure, in words that every program shares.
inline void add_device_option(CLI::App& app, std::string& device) {
  app.add_option("--device", device, "Vulkan device: part of its name, or its index");
}

}  // namespace penumbra::bench
