#include <gtest/gtest.h>

#include "renderer/error.h"
#include "requests/reader.h"

namespace penumbra::requests {
namespace {

using nlohmann::json;

TEST(RequestFromText, sorts_names_into_keys_parameters_and_lights) {
  const json request = request_from_text({{"scene", "boxes"},
                                          {"width", "320"},
                                          {"measure", "true"},
                                          {"map_size", "512"},
                                          {"light.key.position", "1,2.5,-3"},
                                          {"light.key.extent.radius", "0.5"},
                                          {"camera.main.target", "1,0,0"},
                                          {"camera_path", R"([{"up": [0, 0, 1]}])"}});
  EXPECT_EQ(request, json::parse(R"({"scene": "boxes", "width": 320, "measure": true,
      "parameters": {"map_size": "512"},
      "cameras": {"main": {"target": [1.0, 0.0, 0.0]}}, "camera_path": [{"up": [0, 0, 1]}],
      "lights": {"key": {"position": [1.0, 2.5, -3.0], "extent": {"radius": 0.5}}}})"));
}

TEST(RequestFromText, refuses_what_is_no_number_and_what_is_given_twice) {
  const auto field = [](const std::vector<std::pair<std::string, std::string>>& entries) {
    try {
      request_from_text(entries);
    } catch (const Error& error) {
      return error.field;
    }
    return std::string("accepted");
  };
  for (const char* value : {"", "-1", "NaN", "1e3", "600px", "0x10", "99999999999999999999999"})
    EXPECT_EQ(field({{"width", value}}), "width") << value;
  EXPECT_EQ(field({{"measure", "yes"}}), "measure");
  EXPECT_EQ(field({{"width", "1"}, {"width", "2"}}), "width");
  EXPECT_EQ(field({{"bias", "1"}, {"bias", "2"}}), "bias");
  EXPECT_EQ(field({{"light.key", "1"}}), "lights.key");
  EXPECT_EQ(field({{"camera.main", "1"}}), "cameras.main");
  EXPECT_EQ(field({{"camera_path", "around"}}), "camera_path");
  for (const char* whole : {"1", "[1]", "a word", "{\"b\": 1}"})
    EXPECT_EQ(field({{"light.key.a", whole}, {"light.key.a.b", "2"}}), "lights.key.a.b") << whole;
}

}  // namespace
}  // namespace penumbra::requests
