// What of a scene can be chosen for a picture.
#include "tests/http/running_server.h"

namespace penumbra::server::http {
namespace {

TEST_F(RunningServer, TellsCamerasAndLightsOfOneScene) {
  const json document = json::parse(R"({
    "penumbra_scene": 1, "title": "Two lamps",
    "materials": [{"name": "grey"}],
    "meshes": [{"name": "crate", "material": "grey", "generator": "box", "low": [0, 0, 0], "high": [2, 1, 2]}],
    "instances": [{"mesh": "crate"}],
    "lights": [{"name": "lamp", "kind": "point", "position": [1, 2.5, -3]},
               {"name": "sun", "kind": "directional", "direction": [0, -1, 0]}],
    "cameras": [{"name": "near", "position": [0, 1, 5]}, {"name": "far", "position": [0, 1, 50]}]
  })");
  const auto stored = researcher->Put("/api/v1/scenes/lamps", document.dump(), "application/json");
  ASSERT_EQ(stored->status, 201) << stored->body;
  const auto scene = body_of(client->Get("/api/v1/scenes/lamps"), 200, "Scene");
  EXPECT_EQ(scene["cameras"], json::array({"near", "far"}));
  const json lamp{{"name", "lamp"}, {"position", {1.0, 2.5, -3.0}}};
  const json sun{{"name", "sun"}, {"direction", {0.0, -1.0, 0.0}}};
  EXPECT_EQ(scene["lights"], json::array({lamp, sun}));
  EXPECT_DOUBLE_EQ(scene["diagonal"].get<double>(), 3.0);  // of a box of 2 by 1 by 2
}

}  // namespace
}  // namespace penumbra::server::http
