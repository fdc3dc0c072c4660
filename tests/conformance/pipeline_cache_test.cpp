// How many pipelines are kept from picture to picture.
#include <gtest/gtest.h>

#include "renderer/vulkan/pipeline.h"

namespace penumbra::vulkan {
namespace {

TEST(PipelineCache, keeps_those_that_were_used_last) {
  Device device({.validation = true});
  ShaderLibrary library;
  library.add("nothing.comp", "layout(local_size_x = 1) in;\nvoid main() {}\n");
  PipelineCache cache(device, library);
  const auto program = [&](std::size_t number) {
    return &cache.compute("nothing.comp", "#define NUMBER " + std::to_string(number) + "\n");
  };
  program(0);
  const Pipeline* second = program(1);
  cache.trim();
  EXPECT_EQ(cache.size(), 2u);

  constexpr std::size_t more = PipelineCache::most_kept + 10;
  for (std::size_t i = 2; i < more; ++i) program(i);
  EXPECT_EQ(program(1), second);  // nothing is forgotten within a picture
  cache.trim();
  EXPECT_EQ(cache.size(), PipelineCache::most_kept);
  EXPECT_EQ(program(1), second);
  EXPECT_EQ(cache.size(), PipelineCache::most_kept);
  program(0);
  EXPECT_EQ(cache.size(), PipelineCache::most_kept + 1) << "the oldest is compiled anew";
}

}  // namespace
}  // namespace penumbra::vulkan
