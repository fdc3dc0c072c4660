#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "scenes/library.h"
#include "scenes/picture_io.h"
#include "tests/scenes/gltf_file.h"

namespace penumbra::scenes {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::error_of;
using test::GltfFile;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

Scene load_gltf(GltfFile& file) {
  const TemporaryFolder folder;
  return *load(file.write(folder).string());
}

std::string error_of_gltf(GltfFile& file) {
  return error_of([&] { load_gltf(file); });
}

bool has_note(const Scene& scene, const std::string& part) {
  for (const std::string& note : scene.notes)
    if (note.find(part) != std::string::npos) return true;
  return false;
}

TEST(Gltf, GivesAModelAloneACameraALightAndAGroundAndSaysSo) {
  GltfFile file;
  const Scene scene = load_gltf(file);
  EXPECT_EQ(scene.id, "test");
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.receivers.size(), 1u);
  EXPECT_TRUE(has_note(scene, "camera"));
  EXPECT_TRUE(has_note(scene, "light"));
  EXPECT_TRUE(has_note(scene, "ground"));
  // Every corner of the model lies within the field of view.
  const Camera& camera = scene.cameras.at(0);
  const glm::dvec3 forward = glm::normalize(camera.target - camera.position);
  for (const glm::vec3& corner : scene.meshes[0].positions) {
    const double cosine = glm::dot(forward, glm::normalize(glm::dvec3(corner) - camera.position));
    EXPECT_LT(std::acos(cosine) * 180.0 / std::numbers::pi, 0.5 * camera.vertical_fov);
  }
}

TEST(Gltf, ComputesFlatNormalsWhereThereAreNone) {
  GltfFile file;
  const Scene scene = load_gltf(file);
  for (const glm::vec3& normal : scene.meshes[0].normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
}

TEST(Gltf, TurnsStripsAndFansIntoTrianglesThatKeepTheirSide) {
  // A square of four corners: as strip 0 1 2 3 and as fan 0 1 3 2 it has area 1 and looks along +z.
  for (const int mode : {5, 6}) {
    GltfFile file;
    const bool fan = mode == 6;
    const int positions =
        fan ? file.add(bytes_of<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), 5126, 4, "VEC3")
            : file.add(bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}), 5126, 4, "VEC3");
    file.primitive() = {{"attributes", {{"POSITION", positions}}}, {"mode", mode}};
    const Mesh mesh = load_gltf(file).meshes[0];
    ASSERT_EQ(mesh.indices.size(), 6u);
    glm::vec3 doubled(0.0f);
    for (std::size_t i = 0; i < 6; i += 3) {
      const glm::vec3 a = mesh.positions[mesh.indices[i]];
      const glm::vec3 face = glm::cross(mesh.positions[mesh.indices[i + 1]] - a,
                                        mesh.positions[mesh.indices[i + 2]] - a);
      EXPECT_FLOAT_EQ(face.z, 1.0f) << mode;
      doubled += face;
    }
    EXPECT_FLOAT_EQ(doubled.z, 2.0f) << mode;
  }
}

TEST(Gltf, ReadsQuantisedAndNormalisedAttributes) {
  // Normalised: the extremes of a signed short mean -1 and 1, of an unsigned byte for 0 and 1.
  GltfFile file;
  file.document["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int positions =
      file.add(bytes_of<std::int16_t>({-32768, 0, 0, 0, 32767, 0, 0, 0, 0, 16384, 0, 0}), 5122, 3,
               "VEC3", true);
  file.document["bufferViews"].back()["byteStride"] = 8;
  file.document["bufferViews"].back()["byteLength"] = 24;
  const int colors =
      file.add(bytes_of<std::uint8_t>({255, 0, 51, 255, 0, 0, 0, 255, 255, 255, 255, 255}), 5121, 3,
               "VEC4", true);
  file.primitive()["attributes"] = {{"POSITION", positions}, {"COLOR_0", colors}};
  const Mesh mesh = load_gltf(file).meshes[0];
  EXPECT_EQ(mesh.positions[0], glm::vec3(-1, 0, 0));
  EXPECT_EQ(mesh.positions[1], glm::vec3(1, 0, 0));
  EXPECT_NEAR(mesh.positions[2].y, 16384.0f / 32767.0f, 1e-7f);
  EXPECT_NEAR(mesh.colors[0].z, 0.2f, 1e-6f);
  EXPECT_EQ(mesh.colors[0].x, 1.0f);
}

TEST(Gltf, ReplacesTheElementsASparseAccessorNames) {
  GltfFile file;
  file.add(bytes_of<std::uint8_t>({2}), 5121, 1, "SCALAR");
  file.add(bytes_of<float>({5, 6, 7}), 5126, 1, "VEC3");
  file.document["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", 2}, {"componentType", 5121}}},
      {"values", {{"bufferView", 3}}}};
  const Mesh mesh = load_gltf(file).meshes[0];
  EXPECT_EQ(mesh.positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.positions[2], glm::vec3(5, 6, 7));
}

TEST(Gltf, PlacesNodesByTheirParentsAndKeepsMirrors) {
  GltfFile file;
  // Parent: a quarter turn around y, then a move by x; child: mirrored along x.
  const double half = std::sqrt(0.5);
  file.document["nodes"] = {
      {{"children", {1}}, {"rotation", {0.0, half, 0.0, half}}, {"translation", {10.0, 0.0, 0.0}}},
      {{"mesh", 0}, {"scale", {-1.0, 1.0, 1.0}}, {"translation", {0.0, 0.0, 2.0}}}};
  const Scene scene = load_gltf(file);
  const glm::dmat4& matrix = scene.instances[0].world_from_object;
  EXPECT_LT(glm::determinant(glm::dmat3(matrix)), 0.0);
  // A quarter turn takes z to x and -x to z.
  const glm::dvec4 moved = matrix * glm::dvec4(1, 0, 0, 1);
  EXPECT_NEAR(moved.x, 12.0, 1e-12);
  EXPECT_NEAR(moved.z, 1.0, 1e-12);
}

TEST(Gltf, BakesTextureTransformsIntoTheChosenUvs) {
  GltfFile file;
  Image8 picture(2, 1, 4, 255);
  const std::string png = encode_png(picture);
  const int first = file.add(bytes_of<float>({0, 0, 0, 0, 0, 0}), 5126, 3, "VEC2");
  const int second = file.add(bytes_of<float>({0, 0, 1, 0, 0, 1}), 5126, 3, "VEC2");
  file.add(png, 5121, 1, "SCALAR");
  file.document["images"] = {{{"bufferView", 4}, {"mimeType", "image/png"}}};
  file.document["textures"] = {{{"source", 0}}};
  file.document["materials"] = {{{"pbrMetallicRoughness",
                                  {{"baseColorTexture",
                                    {{"index", 0},
                                     {"texCoord", 1},
                                     {"extensions",
                                      {{"KHR_texture_transform",
                                        {{"offset", {0.5, 0.25}},
                                         {"scale", {2.0, 3.0}},
                                         {"rotation", std::numbers::pi / 2}}}}}}}}}}};
  file.primitive()["material"] = 0;
  file.primitive()["attributes"]["TEXCOORD_0"] = first;
  file.primitive()["attributes"]["TEXCOORD_1"] = second;
  const Scene scene = load_gltf(file);
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0].width, 2u);
  // The extension's matrices: uv' = T R S uv with R = [[cos, sin], [-sin, cos]].
  const auto& uvs = scene.meshes[0].uvs;
  EXPECT_NEAR(uvs[1].x, 0.5, 1e-6);
  EXPECT_NEAR(uvs[1].y, 0.25 - 2.0, 1e-6);
  EXPECT_NEAR(uvs[2].x, 0.5 + 3.0, 1e-6);
  EXPECT_NEAR(uvs[2].y, 0.25, 1e-6);
}

TEST(Gltf, TakesLightsAndCamerasAndExposesForThem) {
  GltfFile file;
  file.document["extensionsUsed"] = {"KHR_lights_punctual"};
  file.document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"name", "lamp"},
       {"intensity", 900.0},
       {"spot", {{"outerConeAngle", 0.5}, {"innerConeAngle", 0.25}}}},
      {{"type", "directional"}, {"intensity", 1000.0}, {"color", {1.0, 0.5, 0.25}}}};
  file.document["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.5}}}}};
  file.document["nodes"].push_back({{"translation", {0.0, 0.0, 30.0}},
                                    {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  file.document["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  file.document["nodes"].push_back({{"translation", {0.0, 0.0, 3.0}}, {"camera", 0}});
  file.document["scenes"][0]["nodes"] = {0, 1, 2, 3};
  const Scene scene = load_gltf(file);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].name, "lamp");
  EXPECT_EQ(scene.lights[0].attenuation, Attenuation::inverse_square);
  EXPECT_NEAR(scene.lights[0].outer_angle, 0.5 * 180.0 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(scene.lights[0].direction.z, -1.0, 1e-12);
  EXPECT_EQ(scene.lights[1].kind, LightKind::directional);
  EXPECT_NEAR(scene.cameras[0].vertical_fov, 180.0 / std::numbers::pi, 1e-9);
  EXPECT_EQ(scene.cameras[0].position, glm::dvec3(0, 0, 3));
  // 900 cd from 30 m are 1 lux beside the sun's 1000: white in the sun comes out just above 1.
  EXPECT_NEAR(static_cast<double>(scene.exposure), 1.2 / 1001.0, 1e-4);
  EXPECT_TRUE(has_note(scene, "exposure"));
  EXPECT_TRUE(scene.receivers.empty()) << "a scene with its own light gets no ground";
}

TEST(Gltf, CutsMasksAndSaysWhatItCannotBlend) {
  GltfFile file;
  file.document["materials"] = {
      {{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}, {"doubleSided", true}},
      {{"alphaMode", "BLEND"}, {"name", "window"}}};
  const Scene scene = load_gltf(file);
  EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::mask);
  EXPECT_FLOAT_EQ(scene.materials[0].alpha_cutoff, 0.25f);
  EXPECT_TRUE(scene.materials[0].double_sided);
  EXPECT_FLOAT_EQ(scene.materials[1].alpha_cutoff, 0.5f);
  EXPECT_TRUE(has_note(scene, "window"));
}

TEST(Gltf, LeavesPointsAndLinesOutWithANote) {
  GltfFile file;
  json lines = file.primitive();
  lines["mode"] = 1;
  file.document["meshes"][0]["primitives"].push_back(lines);
  const Scene scene = load_gltf(file);
  EXPECT_EQ(scene.meshes[0].indices.size(), 3u);
  EXPECT_TRUE(has_note(scene, "lines"));
}

// What must be refused, and how the refusal names it.

TEST(GltfFaults, AccessorsThatReachBeyondTheirBuffersAreRefused) {
  const std::vector<std::function<void(json&)>> bends = {
      [](json& d) { d["accessors"][0]["count"] = 4; },
      [](json& d) { d["accessors"][0]["count"] = 4611686018427387904ull; },
      [](json& d) { d["accessors"][0]["byteOffset"] = 18446744073709551600ull; },
      [](json& d) { d["accessors"][0]["byteOffset"] = 4; },
      [](json& d) { d["bufferViews"][0]["byteLength"] = 1000000; },
      [](json& d) { d["bufferViews"][0]["byteOffset"] = 4294967292u; },
      [](json& d) { d["bufferViews"][0]["byteStride"] = 100000; },
      [](json& d) { d["bufferViews"][0]["byteStride"] = 4; },
      [](json& d) { d["bufferViews"][0]["buffer"] = 7; },
      [](json& d) { d["accessors"][0]["bufferView"] = 70; },
      [](json& d) { d["accessors"][0]["type"] = "VEC2"; },
      [](json& d) { d["accessors"][0]["componentType"] = 99; },
      [](json& d) {
        d["accessors"][0].erase("bufferView");
        d["accessors"][0]["count"] = 4000000000u;
      },
      [](json& d) { d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 9; },
      [](json& d) { d["meshes"][0]["primitives"][0]["indices"] = 9; },
      [](json& d) { d["meshes"][0]["primitives"][0]["material"] = 9; },
      [](json& d) {
        d["accessors"][0]["sparse"] = {
            {"count", 1},
            {"indices", {{"bufferView", 1}, {"componentType", 5123}, {"byteOffset", 4}}},
            {"values", {{"bufferView", 0}, {"byteOffset", 30}}}};
      }};
  for (std::size_t i = 0; i < bends.size(); ++i) {
    GltfFile file;
    bends[i](file.document);
    EXPECT_THAT(error_of_gltf(file), HasSubstr("unreadable: test.gltf: ")) << "bend " << i;
  }
}

TEST(GltfFaults, IndicesBeyondTheVerticesAreRefusedByNumber) {
  GltfFile file;
  file.primitive()["indices"] = file.add(bytes_of<std::uint16_t>({0, 1, 3}), 5123, 3, "SCALAR");
  EXPECT_THAT(error_of_gltf(file),
              HasSubstr("meshes[0].primitives[0].indices has the vertex 3 of 3"));
}

TEST(GltfFaults, SparseIndicesBeyondTheAccessorAreRefused) {
  GltfFile file;
  file.add(bytes_of<std::uint8_t>({3}), 5121, 1, "SCALAR");
  file.add(bytes_of<float>({5, 6, 7}), 5126, 1, "VEC3");
  file.document["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", 2}, {"componentType", 5121}}},
      {"values", {{"bufferView", 3}}}};
  EXPECT_THAT(error_of_gltf(file), HasSubstr("sparse.indices"));
}

TEST(GltfFaults, NodesInARingOrWithTwoParentsAreRefused) {
  GltfFile ring;
  ring.document["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
  EXPECT_THAT(error_of_gltf(ring), HasSubstr("its own ancestor"));
  GltfFile self;
  self.document["nodes"] = {{{"children", {0}}, {"mesh", 0}}};
  EXPECT_THAT(error_of_gltf(self), HasSubstr("its own ancestor"));
  GltfFile shared;
  shared.document["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
  EXPECT_THAT(error_of_gltf(shared), HasSubstr("nodes[2] has more than one parent"));
}

TEST(GltfFaults, DeeplyNestedNodesAreRefusedWithoutRecursion) {
  for (const int depth : {600, 100000, 300000}) {
    GltfFile file;
    json nodes = json::array();
    for (int i = 0; i < depth; ++i) nodes.push_back({{"children", {i + 1}}});
    nodes.push_back({{"mesh", 0}});
    file.document["nodes"] = std::move(nodes);
    EXPECT_THAT(error_of_gltf(file),
                HasSubstr(depth < 200000 ? "deeper than 512" : "nodes has more than 200000"));
  }
}

TEST(GltfFaults, DeeplyNestedJsonIsRefusedWithoutRecursion) {
  const TemporaryFolder folder;
  const std::string deep =
      "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(200000, '[') +
      std::string(200000, ']') + "}";
  EXPECT_THAT(error_of([&] { load(folder.write("deep.gltf", deep).string()); }),
              HasSubstr("nested deeper than 64"));
  EXPECT_THAT(error_of([&] { load(folder.write("deep.json", deep).string()); }),
              HasSubstr("nested deeper than 64"));
}

TEST(GltfFaults, NothingOutsideTheFolderIsOpened) {
  const TemporaryFolder outside;
  const GltfFile plain;
  outside.write("secret.bin", plain.buffer);
  outside.write("scene/here.txt", "");
  std::filesystem::create_symlink(outside.path / "secret.bin", outside.path / "scene" / "link.bin");
  for (const std::string& uri :
       {std::string("../secret.bin"), (outside.path / "secret.bin").string(),
        std::string("%2e%2e/secret.bin"), std::string("..%2Fsecret.bin"),
        "file://" + (outside.path / "secret.bin").string(),
        std::string("http://127.0.0.1:1/secret.bin"), std::string("..\\secret.bin"),
        std::string("link.bin"), std::string("a/../../secret.bin"),
        std::string("secret.bin%00.png"), std::string("")}) {
    GltfFile file;
    file.document["buffers"] = {{{"uri", uri}, {"byteLength", file.buffer.size()}}};
    outside.write("scene/test.gltf", file.document.dump());
    const std::string message =
        error_of([&] { load((outside.path / "scene" / "test.gltf").string()); });
    EXPECT_THAT(message, AllOf(HasSubstr("unreadable"), HasSubstr("buffers[0].uri"))) << uri;
  }
}

TEST(GltfFaults, DamagedAndHugePicturesAreLeftOutByName) {
  // A PNG whose header says 100000 x 100000 pixels, and a JPEG that ends after its header.
  std::string huge = encode_png(Image8(1, 1, 4, 255));
  huge.replace(16, 8, std::string("\x00\x01\x86\xa0\x00\x01\x86\xa0", 8));
  for (const std::string& bytes :
       {huge, std::string("\xff\xd8\xff\xe0\x00\x10JFIF\0\x01", 12), std::string("GIF89a......")}) {
    GltfFile file;
    file.add(bytes, 5121, 1, "SCALAR");
    file.document["images"] = {{{"bufferView", 2}, {"mimeType", "image/png"}}};
    file.document["textures"] = {{{"source", 0}}};
    file.document["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    file.primitive()["material"] = 0;
    const Scene scene = load_gltf(file);
    EXPECT_EQ(scene.materials[0].texture, -1);
    EXPECT_TRUE(has_note(scene, "images[0]: the picture"));
  }
}

TEST(GltfFaults, OtherVersionsAndUnknownRequiredExtensionsAreNamed) {
  GltfFile old;
  old.document["asset"]["version"] = "1.0";
  EXPECT_THAT(error_of_gltf(old), AllOf(HasSubstr("unsupported"), HasSubstr("1.0")));
  GltfFile none;
  none.document.erase("asset");
  EXPECT_THAT(error_of_gltf(none), HasSubstr("asset.version"));
  GltfFile extended;
  extended.document["extensionsRequired"] = {"EXT_from_the_future"};
  EXPECT_THAT(error_of_gltf(extended), HasSubstr("EXT_from_the_future"));
}

}  // namespace
}  // namespace penumbra::scenes
