#include "server/jobs/canonical_request.h"

#include <gmock/gmock.h>

#include "renderer/error.h"
#include "requests/fields.h"
#include "scenes/library.h"
#include "server/files/digest.h"
#include "server/jobs/drawing_version.h"

namespace penumbra::server {
namespace {

using nlohmann::json;

const RequestContext nowhere{};

json plain() {
  return {{"scene", "half-plane"}, {"technique", "none"}};
}

json plain_with(const std::string& key, const json& value) {
  json request = plain();
  request[key] = value;
  return request;
}

/// Field that a refusal names, or "accepted".
std::string refused_field(const json& request) {
  try {
    read_request(request, nowhere);
  } catch (const Error& error) {
    EXPECT_THAT(error.code, testing::AnyOf("bad_value", "not_found"));
    return error.field;
  }
  return "accepted";
}

TEST(CanonicalRequest, fills_in_every_default) {
  const CanonicalRequest canonical = read_request(plain(), nowhere);
  const RenderRequest defaults;
  EXPECT_EQ(canonical.request.at("width"), defaults.width);
  EXPECT_EQ(canonical.request.at("height"), defaults.height);
  EXPECT_EQ(canonical.request.at("supersampling"), defaults.supersampling);
  EXPECT_EQ(canonical.request.at("light_samples"), defaults.light_samples);
  EXPECT_EQ(canonical.request.at("seed"), defaults.seed);
  EXPECT_EQ(canonical.request.at("exposure"), 0.0) << "log2 of the factor of a built-in scene, 1";
  EXPECT_EQ(canonical.request.at("camera"), canonical.scene->cameras.front().name);
  EXPECT_EQ(canonical.request.at("scene_hash").get<std::string>().size(), 32u);
  EXPECT_EQ(canonical.request.at("renderer"), drawing_version());
  EXPECT_FALSE(canonical.request.at("parameters").empty());
  EXPECT_FALSE(canonical.measure);
}

TEST(CanonicalRequest, is_the_same_however_its_values_are_written) {
  const std::string id = read_request(plain(), nowhere).id;
  EXPECT_EQ(id.size(), 32u);
  EXPECT_EQ(read_request(plain_with("width", RenderRequest{}.width), nowhere).id, id);
  EXPECT_EQ(read_request(plain_with("width", 1.0 * RenderRequest{}.width), nowhere).id, id);
  EXPECT_EQ(read_request(plain_with("parameters", json::object()), nowhere).id, id);
  EXPECT_EQ(read_request(plain_with("camera", nullptr), nowhere).id, id);
  EXPECT_EQ(read_request(plain_with("exposure", 0), nowhere).id, id);
  EXPECT_EQ(read_request(plain_with("exposure", -0.0), nowhere).id, id);
  EXPECT_EQ(read_request(plain_with("lights", {{"key", json::object()}}), nowhere).id, id);
}

TEST(CanonicalRequest, has_another_id_when_the_picture_may_differ_and_only_then) {
  const std::string id = read_request(plain(), nowhere).id;
  EXPECT_NE(read_request(plain_with("width", 601), nowhere).id, id);
  EXPECT_NE(read_request(plain_with("seed", 2), nowhere).id, id);
  EXPECT_NE(read_request(plain_with("exposure", -1.5), nowhere).id, id);
  EXPECT_NE(read_request(plain_with("scene", "boxes"), nowhere).id, id);
  EXPECT_NE(read_request(plain(), {{}, "another device", false}).id, id);
  EXPECT_EQ(read_request(plain_with("measure", true), nowhere).id, id);
  EXPECT_EQ(read_request(plain_with("frames", 5), nowhere).id, id);
}

TEST(CanonicalRequest, expands_presets_to_the_technique_they_set) {
  for (const techniques::Preset& preset : techniques::presets()) {
    const CanonicalRequest by_preset = read_request(plain_with("technique", preset.id), nowhere);
    EXPECT_EQ(by_preset.request.at("technique"), preset.technique);
    json spelt_out = plain_with("technique", preset.technique);
    spelt_out["parameters"] = by_preset.request.at("parameters");
    EXPECT_EQ(read_request(spelt_out, nowhere).id, by_preset.id) << preset.id;
  }
}

TEST(CanonicalRequest, names_the_field_that_is_out_of_range) {
  for (const char* size : {"width", "height"}) {
    EXPECT_EQ(refused_field(plain_with(size, 0)), size);
    EXPECT_EQ(refused_field(plain_with(size, -1)), size);
    EXPECT_EQ(refused_field(plain_with(size, 100000)), size);
    EXPECT_EQ(refused_field(plain_with(size, 600.5)), size);
    EXPECT_EQ(refused_field(plain_with(size, 1e300)), size);
    EXPECT_EQ(refused_field(plain_with(size, "600")), size);
    EXPECT_EQ(refused_field(plain_with(size, std::numeric_limits<double>::quiet_NaN())), size);
    EXPECT_EQ(refused_field(plain_with(size, std::numeric_limits<double>::infinity())), size);
    EXPECT_EQ(refused_field(plain_with(size, RenderLimits::max_size)), "accepted");
  }
  EXPECT_EQ(refused_field(plain_with("supersampling", 2)), "supersampling");
  EXPECT_EQ(refused_field(plain_with("supersampling", 16)), "accepted");
  EXPECT_EQ(refused_field(plain_with("light_samples", 0)), "light_samples");
  EXPECT_EQ(refused_field(plain_with("light_samples", 65537)), "light_samples");
  for (const double exposure : {-30.5, 30.5, 1e300})
    EXPECT_EQ(refused_field(plain_with("exposure", exposure)), "exposure");
  EXPECT_EQ(refused_field(plain_with("exposure", "bright")), "exposure");
  EXPECT_EQ(refused_field(plain_with("seed", -1)), "seed");
  EXPECT_EQ(refused_field(plain_with("seed", 1e17)), "seed");
  EXPECT_EQ(refused_field(plain_with("frames", 1001)), "frames");
}

TEST(CanonicalRequest, names_the_field_of_the_wrong_type) {
  EXPECT_EQ(refused_field(plain_with("scene", 5)), "scene");
  EXPECT_EQ(refused_field(plain_with("scene", "")), "scene");
  EXPECT_EQ(refused_field({{"technique", "none"}}), "scene");
  EXPECT_EQ(refused_field({{"scene", "boxes"}}), "technique");
  EXPECT_EQ(refused_field(plain_with("parameters", json::array())), "parameters");
  EXPECT_EQ(refused_field(plain_with("lights", "bright")), "lights");
  EXPECT_EQ(refused_field(plain_with("measure", 1)), "measure");
  EXPECT_EQ(refused_field(plain_with("camera", 1)), "camera");
  EXPECT_EQ(refused_field(json::array()), "");
}

TEST(CanonicalRequest, refuses_names_that_are_not_there) {
  EXPECT_EQ(refused_field(plain_with("wdith", 600)), "wdith");
  EXPECT_EQ(refused_field(plain_with("scene", "no-such-scene")), "scene");
  EXPECT_EQ(refused_field(plain_with("technique", "no-such-technique")), "technique");
  EXPECT_EQ(refused_field(plain_with("camera", "no-such-camera")), "camera");
  EXPECT_EQ(refused_field(plain_with("diagnostic", "no-such-picture")), "diagnostic");
  EXPECT_EQ(refused_field(plain_with("parameters", {{"no-such-parameter", 1}})),
            "no-such-parameter");
  EXPECT_THAT(refused_field(plain_with("lights", {{"no-such-light", {{"intensity", 2}}}})),
              testing::StartsWith("lights"));
}

TEST(CanonicalRequest, names_the_camera_of_a_path_that_is_wrong) {
  const auto path_with = [](const json& wrong) {
    const json good = {{"position", {0, 2, 5}}};
    return plain_with("camera_path", json::array({good, good, good, wrong}));
  };
  EXPECT_EQ(refused_field(path_with({{"field_of_view", 180}})), "camera_path[3].field_of_view");
  EXPECT_EQ(refused_field(path_with({{"field_of_view", "wide"}})), "camera_path[3].field_of_view");
  EXPECT_EQ(refused_field(path_with({{"position", {0, 1}}})), "camera_path[3].position");
  EXPECT_EQ(refused_field(path_with({{"direction", {0, 0, 0}}})), "camera_path[3].direction");
  EXPECT_EQ(refused_field(path_with({{"direction", {0, 0, 1}}, {"target", {0, 0, 0}}})),
            "camera_path[3].direction");
  EXPECT_EQ(refused_field(path_with({{"zoom", 2}})), "camera_path[3].zoom");
  EXPECT_EQ(refused_field(path_with({{"name", "other"}})), "camera_path[3].name");
  EXPECT_EQ(refused_field(path_with(5)), "camera_path[3]");
  EXPECT_EQ(refused_field(plain_with("camera_path", "around")), "camera_path");
  const json still = json::object();
  EXPECT_EQ(refused_field(plain_with("camera_path", std::vector<json>(1000, still))), "accepted");
  EXPECT_EQ(refused_field(plain_with("camera_path", std::vector<json>(1001, still))),
            "camera_path");
}

TEST(CanonicalRequest, draws_the_last_camera_of_a_path_after_the_others) {
  json request = plain();
  request["camera_path"] = {{{"position", {1, 2, 3}}, {"direction", {0, -2, 0}}},
                            {{"position", {4, 5, 6}}, {"field_of_view", 33}}};
  const CanonicalRequest canonical = read_request(request, nowhere);
  const RenderRequest drawn = to_render_request(canonical);
  const Camera& before = canonical.scene->cameras.front();
  const Camera& last = drawn.scene->cameras.front();
  EXPECT_EQ(last.position, glm::dvec3(4, 5, 6));
  EXPECT_EQ(last.target, before.target);
  EXPECT_EQ(last.vertical_fov, 33.0);
  ASSERT_EQ(drawn.earlier_cameras.size(), 1u);
  EXPECT_EQ(drawn.earlier_cameras[0].position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(drawn.earlier_cameras[0].target, glm::dvec3(1, 0, 3));
  EXPECT_EQ(drawn.earlier_cameras[0].vertical_fov, before.vertical_fov);

  // What a path leaves open is filled in; read again, or written otherwise, it is the same picture.
  EXPECT_EQ(canonical.request["camera_path"][1]["vertical_fov"], 33.0);
  request["camera_path"] = canonical.request["camera_path"];
  EXPECT_EQ(read_request(request, nowhere).id, canonical.id);
  EXPECT_NE(read_request(plain(), nowhere).id, canonical.id);

  // The truth remembers nothing: it is judged from where the path ends.
  EXPECT_TRUE(to_render_request(reference_of(canonical, nowhere)).earlier_cameras.empty());
  EXPECT_EQ(to_render_request(reference_of(canonical, nowhere)).scene->cameras.front().position,
            last.position);
}

TEST(CanonicalRequest, replaces_keys_of_the_camera_that_it_names) {
  const std::string name = read_request(plain(), nowhere).request.at("camera");
  const auto with = [&](const json& keys) { return plain_with("cameras", {{name, keys}}); };
  const CanonicalRequest canonical = read_request(with({{"field_of_view", 20}}), nowhere);
  EXPECT_EQ(to_render_request(canonical).scene->cameras.front().vertical_fov, 20.0);
  EXPECT_EQ(read_request(with({{"field_of_view", 20.0}}), nowhere).id, canonical.id);
  EXPECT_EQ(read_request(with(json::object()), nowhere).id, read_request(plain(), nowhere).id);
  EXPECT_EQ(refused_field(with({{"field_of_view", 0}})), "cameras." + name + ".field_of_view");
  EXPECT_EQ(refused_field(plain_with("cameras", {{"no-such", {{"up", {0, 1, 0}}}}})),
            "cameras.no-such");
}

// Scenes lie above the declaration of fields, so that both say it.
TEST(CanonicalRequest, tells_every_way_to_name_a_scene) {
  EXPECT_EQ(requests::find_field("scene")->meaning, scenes::ways_to_name_a_scene());
}

TEST(CanonicalRequest, opens_no_files_for_strangers) {
  EXPECT_EQ(refused_field(plain_with("scene", "/etc/passwd")), "scene");
  EXPECT_EQ(refused_field(plain_with("scene", "../scenes/x.glb")), "scene");
  EXPECT_EQ(refused_field(plain_with("scene", ".")), "scene");
  EXPECT_EQ(refused_field(plain_with("scene", std::string("boxes\0.glb", 10))), "scene");
}

TEST(CanonicalRequest, is_judged_against_the_truth_of_the_same_view) {
  json request = plain_with("width", 320);
  request["seed"] = 7;
  const CanonicalRequest canonical = read_request(request, nowhere);
  const CanonicalRequest reference = reference_of(canonical, nowhere);
  EXPECT_EQ(reference.technique.technique->family, "truth");
  EXPECT_EQ(reference.request.at("width"), 320);
  EXPECT_EQ(reference.request.at("scene_hash"), canonical.request.at("scene_hash"));
  EXPECT_EQ(reference.request.at("seed"), RenderRequest{}.seed);

  // Asked for by name it is the very same render.
  json by_name = plain_with("width", 320);
  by_name["technique"] = reference.technique.technique->id;
  EXPECT_EQ(read_request(by_name, nowhere).id, reference.id);
}

TEST(Digest, is_sha_256) {
  // FIPS 180-4, examples.
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace penumbra::server
