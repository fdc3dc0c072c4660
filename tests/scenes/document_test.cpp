#include "scenes/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "scenes/document_meshes.h"
#include "scenes/export.h"
#include "scenes/generators/textures.h"
#include "scenes/library.h"
#include "tests/scenes/gltf_file.h"
#include "tests/scenes/watertight.h"

namespace penumbra::scenes {
namespace {

using nlohmann::json;
using test::error_of;
using test::TemporaryFolder;
using testing::HasSubstr;

json schema_text() {
  std::ifstream stream(PENUMBRA_SOURCE_DIR "/schema/scene.schema.json");
  return json::parse(stream);
}

bool fits_schema(const json& document) {
  static const auto schema = [] {
    auto parsed = std::make_unique<valijson::Schema>();
    valijson::SchemaParser parser;
    const json text = schema_text();
    parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(text), *parsed);
    return parsed;
  }();
  valijson::Validator validator;
  return validator.validate(*schema, valijson::adapters::NlohmannJsonAdapter(document), nullptr);
}

/// A document that uses every kind of element.
json example() {
  return {{"penumbra_scene", 1},
          {"id", "example"},
          {"title", "An example"},
          {"textures", {{{"name", "boards"}, {"generator", "wood"}, {"size", 32}, {"seed", 3}}}},
          {"materials",
           {{{"name", "wood"}, {"texture", "boards"}, {"base_color", {1, 0.9, 0.8}}},
            {{"name", "grey"}, {"specular", 0.2}, {"shininess", 64}}}},
          {"meshes",
           {{{"name", "crate"},
             {"generator", "rounded_box"},
             {"low", {-0.5, 0, -0.5}},
             {"high", {0.5, 1, 0.5}},
             {"radius", 0.02},
             {"segments", 1},
             {"material", "wood"},
             {"tile", 2}},
            {{"name", "triangle"},
             {"positions", {0, 0, 0, 1, 0, 0, 0, 1, 0}},
             {"indices", {0, 1, 2}},
             {"primitives", {{{"first_index", 0}, {"index_count", 3}, {"material", 1}}}}}}},
          {"instances",
           {{{"mesh", "crate"}, {"position", {1, 0, 2}}, {"rotation", {0, 90, 0}}, {"scale", 2}},
            {{"mesh", 1},
             {"casts_shadow", false},
             {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1}}}}},
          {"lights",
           {{{"name", "lamp"},
             {"kind", "spot"},
             {"position", {0, 5, 0}},
             {"target", {0, 0, 0}},
             {"extent", {{"kind", "disc"}, {"radius", 0.3}}}}}},
          {"cameras",
           {{{"name", "main"},
             {"position", {4, 3, 5}},
             {"target", {0, 0.5, 0}},
             {"vertical_fov", 40}}}},
          {"receivers",
           {{{"name", "floor"}, {"corners", {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}}}}},
          {"ambient", {0.1, 0.1, 0.1}},
          {"exposure", 1.5}};
}

TEST(Document, DescribesASceneByGeneratorsArraysAndNames) {
  const json document = example();
  EXPECT_TRUE(fits_schema(document));
  const Scene scene = read_document(document, {});
  validate(scene);
  EXPECT_EQ(scene.materials[0].texture, 0);
  EXPECT_EQ(scene.meshes[0].indices.size() / 3, 108u);
  EXPECT_EQ(scene.lights[0].direction, glm::dvec3(0, -1, 0));
  EXPECT_EQ(scene.lights[0].extent.radius, 0.3);
  EXPECT_FLOAT_EQ(scene.exposure, 1.5f);
  EXPECT_FALSE(scene.instances[1].casts_shadow);
  EXPECT_EQ(scene.instances[1].world_from_object[3], glm::dvec4(4, 5, 6, 1));
  // Turned by 90 degrees around y, what lay along x lies along -z; twice as large.
  const glm::dvec4 corner = scene.instances[0].world_from_object * glm::dvec4(0.5, 0, 0, 1);
  EXPECT_NEAR(corner.x, 1.0, 1e-9);
  EXPECT_NEAR(corner.z, 1.0, 1e-9);
}

TEST(Document, ScenesComeBackEqual) {
  for (const char* id : {"half-plane", "three-layers", "disco-box", "sweep:5x100x3"}) {
    const auto scene = load(id);
    const json document = json::parse(write_document(*scene).dump());
    EXPECT_EQ(content_hash(read_document(document, {})), content_hash(*scene)) << id;
  }
}

TEST(Export, EveryBuiltInSceneComesBackEqual) {
  const TemporaryFolder folder;
  for (const SceneInfo& info : built_in()) {
    const auto scene = load(info.id);
    const auto file = folder.write(info.id + ".glb", encode_glb(*scene));
    EXPECT_EQ(content_hash(*load(file.string())), content_hash(*scene)) << info.id;
  }
}

TEST(Document, WhatIsWrittenFitsTheSchema) {
  for (const char* id : {"half-plane", "contact", "sweep:5x100x3"})
    EXPECT_TRUE(fits_schema(write_document(*load(id)))) << id;
}

TEST(Document, ImportedScenesAreFoundByTheirId) {
  const TemporaryFolder data;
  data.write("scenes/mine/scene.json", example().dump());
  data.write("scenes/other.glb", encode_glb(*load("contact")));
  const auto mine = load("mine", data.path);
  EXPECT_EQ(mine->id, "mine");
  EXPECT_EQ(load("other", data.path)->lights.size(), 1u);
  EXPECT_THAT(error_of([&] { load("nobody", data.path); }),
              testing::AllOf(HasSubstr("not_found"), HasSubstr("mine"), HasSubstr("other")));
  EXPECT_THAT(error_of([&] { load("../scenes/mine", data.path); }), HasSubstr("not_found"));
}

TEST(Document, KeepsGeoreferencedCoordinatesToTheMillimetre) {
  json document = example();
  const std::vector<double> positions = {512345.251, 120.802, -5412345.753,
                                         512346.254, 120.805, -5412345.756,
                                         512345.257, 121.808, -5412344.759};
  document["meshes"][1]["positions"] = positions;
  document["instances"][1] = {{"mesh", 1}, {"position", {0, 0, 2}}, {"rotation", {0, 180, 0}}};
  const Scene scene = read_document(document, {});
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 place(scene.instances[1].world_from_object *
                           glm::dvec4(glm::dvec3(scene.meshes[1].positions[i]), 1.0));
    const glm::dvec3 right(-positions[3 * i], positions[3 * i + 1], 2.0 - positions[3 * i + 2]);
    EXPECT_LT(glm::distance(place, right), 1e-5) << i;
  }
}

TEST(Document, TakesModelsFromItsFolderAndFromNowhereElse) {
  const TemporaryFolder folder;
  folder.write("models/box.glb", encode_glb(*load("contact")));
  json document = example();
  document["models"] = {{{"file", "models/box.glb"}, {"position", {0, 0, 9}}}};
  EXPECT_TRUE(fits_schema(document));
  const Scene scene = read_document(document, folder.path);
  validate(scene);
  EXPECT_EQ(scene.instances.size(), 2 + load("contact")->instances.size());
  document["models"][0]["file"] = "../box.glb";
  EXPECT_THAT(error_of([&] { read_document(document, folder.path); }), HasSubstr("models[0].file"));
  document["models"][0]["file"] = "models/box.glb";
  EXPECT_THAT(error_of([&] { read_document(document, {}); }), HasSubstr("may name no files"));
}

struct Bend {
  const char* path;  ///< what the message must name
  std::function<void(json&)> apply;
};

TEST(Document, RefusesWhatTheSchemaRefusesAndNamesThePath) {
  const std::vector<Bend> bends = {
      {"colour", [](json& d) { d["colour"] = 1; }},
      {"penumbra_scene", [](json& d) { d["penumbra_scene"] = 2; }},
      {"penumbra_scene", [](json& d) { d.erase("penumbra_scene"); }},
      {"lights[0].extend", [](json& d) { d["lights"][0]["extend"] = 1; }},
      {"lights[0].kind", [](json& d) { d["lights"][0]["kind"] = "lantern"; }},
      {"lights[0].intensity", [](json& d) { d["lights"][0]["intensity"] = -1; }},
      {"lights[0].intensity", [](json& d) { d["lights"][0]["intensity"] = "bright"; }},
      {"lights[0].outer_angle", [](json& d) { d["lights"][0]["outer_angle"] = 90; }},
      {"lights[0].extent.radius", [](json& d) { d["lights"][0]["extent"]["radius"] = -0.1; }},
      {"lights[0].position",
       [](json& d) {
         d["lights"][0]["position"] = {1, 2};
       }},
      {"cameras[0].vertical_fov", [](json& d) { d["cameras"][0]["vertical_fov"] = 180; }},
      {"materials[1].shininess", [](json& d) { d["materials"][1]["shininess"] = 0; }},
      {"materials[0].base_color[1]", [](json& d) { d["materials"][0]["base_color"][1] = -0.5; }},
      {"meshes[0].segments", [](json& d) { d["meshes"][0]["segments"] = 1000; }},
      {"meshes[0].generator", [](json& d) { d["meshes"][0]["generator"] = "teapot"; }},
      {"instances[0].mesh", [](json& d) { d["instances"][0].erase("mesh"); }},
      {"instances[1].matrix",
       [](json& d) {
         d["instances"][1]["matrix"] = {1, 2, 3};
       }},
      {"textures[0]", [](json& d) { d["textures"][0]["size"] = 100000; }},
      {"receivers[0].corners", [](json& d) { d["receivers"][0].erase("corners"); }},
      {"exposure", [](json& d) { d["exposure"] = 0; }}};
  for (const Bend& bend : bends) {
    json document = example();
    bend.apply(document);
    EXPECT_FALSE(fits_schema(document)) << bend.path;
    EXPECT_THAT(error_of([&] { read_document(document, {}); }),
                testing::AllOf(HasSubstr("unreadable"), HasSubstr(bend.path)));
  }
}

TEST(Document, RefusesWhatNoSchemaCanSay) {
  const std::vector<Bend> bends = {
      {"instances[0].mesh", [](json& d) { d["instances"][0]["mesh"] = "crates"; }},
      {"materials[0].texture", [](json& d) { d["materials"][0]["texture"] = "bricks"; }},
      {"meshes[0].radius", [](json& d) { d["meshes"][0]["radius"] = 0.6; }},
      {"meshes[0].slices", [](json& d) { d["meshes"][0]["slices"] = 20; }},
      {"meshes[1].indices",
       [](json& d) {
         d["meshes"][1]["indices"] = {0, 1, 3};
       }},
      {"lights[0].up",
       [](json& d) {
         d["lights"][0]["up"] = {0, 2, 0};
       }},
      {"lights[1].name", [](json& d) { d["lights"].push_back(d["lights"][0]); }},
      {"cameras[0].up", [](json& d) { d["cameras"][0]["target"] = d["cameras"][0]["position"]; }}};
  for (const Bend& bend : bends) {
    json document = example();
    bend.apply(document);
    EXPECT_THAT(error_of([&] { read_document(document, {}); }),
                testing::AllOf(HasSubstr("unreadable"), HasSubstr(bend.path)));
  }
}

TEST(Document, SchemaListsTheGeneratorsThereAre) {
  const json definitions = schema_text()["definitions"];
  EXPECT_EQ(definitions["texture"]["properties"]["generator"]["enum"], json(texture_generators()));
  EXPECT_EQ(definitions["mesh"]["properties"]["generator"]["enum"], json(mesh_generators()));
}

TEST(Document, EveryMeshGeneratorGivesAClosedMeshByItsDefaults) {
  json document = example();
  for (const std::string& name : mesh_generators()) {
    json mesh = {{"name", name}, {"generator", name}, {"material", 0}};
    if (name == "lathe") mesh["profile"] = {{0, 0}, {1, 0}, {0.5, 2}, {0, 2}};
    if (name == "extrusion") mesh["polygon"] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    if (name == "tube") mesh["path"] = {{0, 0, 0}, {0, 1, 0}, {1, 2, 0}};
    document["meshes"].push_back(mesh);
  }
  EXPECT_TRUE(fits_schema(document));
  const Scene scene = read_document(document, {});
  for (std::size_t i = 2; i < scene.meshes.size(); ++i) {
    EXPECT_EQ(test::leak_of(scene.meshes[i]), "") << scene.meshes[i].name;
    EXPECT_GT(test::volume_of(scene.meshes[i]), 0.0) << scene.meshes[i].name;
  }
}

TEST(LightOverrides, ReplaceTheKeysTheyNameAndNoOther) {
  const Scene scene = *load("contact");
  const Scene changed = with_light_overrides(
      scene, {{"lamp", {{"intensity", 2}, {"extent", {{"kind", "sphere"}, {"radius", 0.5}}}}}});
  EXPECT_EQ(changed.lights[0].intensity, 2.0f);
  EXPECT_EQ(changed.lights[0].extent.kind, ExtentKind::sphere);
  EXPECT_EQ(changed.lights[0].position, scene.lights[0].position);
  Scene back = changed;
  back.lights = scene.lights;
  EXPECT_EQ(content_hash(back), content_hash(scene));
  EXPECT_EQ(content_hash(with_light_overrides(scene, json::object())), content_hash(scene));
}

TEST(LightOverrides, NameTheFieldThatIsWrong) {
  const Scene scene = *load("contact");
  const auto field_of = [&](const json& overrides) {
    try {
      with_light_overrides(scene, overrides);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, "bad_value");
      return error.field;
    }
    return std::string("no error");
  };
  EXPECT_EQ(field_of({{"sun", {{"intensity", 2}}}}), "lights.sun");
  EXPECT_EQ(field_of({{"lamp", {{"intensity", -2}}}}), "lights.lamp.intensity");
  EXPECT_EQ(field_of({{"lamp", {{"extent", {{"radius", "wide"}}}}}}), "lights.lamp.extent.radius");
  EXPECT_EQ(field_of({{"lamp", {{"brightness", 2}}}}), "lights.lamp.brightness");
  EXPECT_EQ(field_of({{"lamp", 3}}), "lights.lamp");
  EXPECT_EQ(field_of({{"lamp", {{"name", "sun"}}}}), "lights.lamp.name");
  EXPECT_EQ(field_of(json::array()), "lights");
}

}  // namespace
}  // namespace penumbra::scenes
