// Files that people have: each comes in by `load`, and again from the binary glTF that `import`
// keeps, as the same scene with the same notes.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "scenes/base64.h"
#include "scenes/document.h"
#include "scenes/export.h"
#include "scenes/import/import.h"
#include "scenes/import/side_files.h"
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
using testing::Contains;
using testing::HasSubstr;

/// Loads a file by both doors.
Scene load_twice(const std::filesystem::path& file) {
  const auto scene = load(file.string());
  const TemporaryFolder folder;
  const auto again = load(folder.write("again.glb", encode_glb(*scene)).string());
  EXPECT_EQ(content_hash(*again), content_hash(*scene)) << file;
  EXPECT_EQ(again->notes, scene->notes) << file;
  return *scene;
}

Scene load_twice(GltfFile& file) {
  const TemporaryFolder folder;
  return load_twice(file.write(folder));
}

/// The file with a material that shows an image, and uvs to show it by.
GltfFile textured(const json& image, std::vector<float> uvs = {0, 0, 1, 0, 0, 1}) {
  GltfFile file;
  file.primitive()["attributes"]["TEXCOORD_0"] = file.add(bytes_of(uvs), 5126, 3, "VEC2");
  file.document["images"] = json::array({image});
  file.document["textures"] = {{{"source", 0}}};
  file.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  file.primitive()["material"] = 0;
  return file;
}

std::string png(std::uint8_t grey) {
  return encode_png(Image8(2, 2, 4, grey));
}

TEST(Doors, PointsAndLinesAreLeftOutInAnyMesh) {
  for (const int mode : {0, 1, 2, 3}) {
    GltfFile file;
    json only = file.document["meshes"][0];
    only["primitives"][0]["mode"] = mode;
    only["name"] = "wire";
    // Before the surface and after it, used and not.
    file.document["meshes"] = {only, file.document["meshes"][0], only};
    file.document["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}};
    file.document["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = load_twice(file);
    EXPECT_EQ(scene.meshes[0].indices.size(), 3u);
    EXPECT_THAT(scene.notes, Contains(HasSubstr("meshes[0] 'wire'.primitives[0] consists of")));
  }
}

TEST(Doors, NamesOfFilesMeanWhatTheySay) {
  const std::vector<std::pair<std::string, std::string>> names = {
      {"wood+oak.png", "wood+oak.png"},
      {"wood oak.png", "wood%20oak.png"},
      {"wood oak.png", "wood oak.png"},
      {"a/b/h\xc3\xb6lz.png", "a/b/h%C3%B6lz.png"},
      {"h\xc3\xb6lz.png", "h\xc3\xb6lz.png"},
      {"50%.png", "50%25.png"},
      {"50%.png", "50%.png"},
      {"a%20b.png", "a%20b.png"},
      {"x&y=(1)#.png", "x&y=(1)%23.png"},
      {"./here.png", "./here.png"}};
  for (const auto& [name, uri] : names) {
    const TemporaryFolder folder;
    folder.write(name, png(90));
    GltfFile file = textured({{"uri", uri}});
    const Scene scene = load_twice(file.write(folder));
    ASSERT_EQ(scene.textures.size(), 1u) << uri;
    EXPECT_EQ(scene.textures[0].rgba[0], 90) << uri;
  }
  const TemporaryFolder folder;
  GltfFile file;
  folder.write("some data+1.bin", file.buffer + "and more than is said");
  file.document["buffers"] = {{{"uri", "some%20data+1.bin"}, {"byteLength", file.buffer.size()}}};
  EXPECT_EQ(load_twice(file.write(folder)).meshes[0].indices.size(), 3u);
}

TEST(Doors, DataUrisMayBeOfAnyType) {
  GltfFile plain;
  std::string packed = base64_encode(plain.buffer);
  std::string bare = packed.substr(0, packed.find('=')), broken = packed, other = packed;
  broken.insert(8, "\n ");
  for (char& c : other) c = c == '+' ? '-' : c == '/' ? '_' : c;
  std::string escaped;
  for (const char c : plain.buffer) {
    char code[4];
    std::snprintf(code, sizeof code, "%%%02x", static_cast<unsigned char>(c));
    escaped += code;
  }
  for (const std::string& uri :
       {"data:application/octet-stream;base64," + packed, "data:;base64," + packed,
        "data:application/gltf-buffer;base64," + packed, "DATA:Text/Plain;BASE64," + packed,
        "data:model/x-anything;charset=utf-8;name=a.bin;base64," + packed, "data:;base64," + bare,
        "data:;base64," + broken, "data:;base64," + other, "data:," + escaped}) {
    GltfFile file;
    file.document["buffers"] = {{{"uri", uri}, {"byteLength", file.buffer.size()}}};
    EXPECT_EQ(load_twice(file).meshes[0].positions[1], glm::vec3(1, 0, 0)) << uri;
    GltfFile picture = textured(
        {{"uri", uri.substr(0, uri.find(',') + 1) + (uri.find("base64") == uri.npos && uri[5] == ','
                                                         ? std::string("%89")
                                                         : base64_encode(png(90)))}});
    EXPECT_EQ(load_twice(picture).textures.size(), uri[5] == ',' ? 0u : 1u) << uri;
  }
  GltfFile wrong;
  wrong.document["buffers"] = {
      {{"uri", "data:;base64," + std::string(3000000, '*')}, {"byteLength", 4}}};
  const std::string message = error_of([&] { load_twice(wrong); });
  EXPECT_THAT(message, HasSubstr("buffers[0].uri"));
  EXPECT_LT(message.size(), 300u);
}

TEST(Doors, PicturesThatCannotBeUsedAreNotes) {
  const TemporaryFolder outside;
  outside.write("secret.png", png(1));
  for (const char* uri :
       {"http://127.0.0.1:1/x.png", "https://a/b.png", "../secret.png", "..\\secret.png",
        "%2e%2e/secret.png", "/etc/passwd", "C:\\x.png", "missing.png", "bad.png", "scene.ktx2",
        "data:image/png;base64,****", "data:image/png;base64,AAAA", "data:nothing"}) {
    outside.write("scene/bad.png", "no picture");
    outside.write("scene/scene.ktx2", "\xabKTX 20\xbb\r\n");
    GltfFile file = textured({{"uri", uri}});
    outside.write("scene/test.bin", file.buffer);
    file.document["buffers"] = {{{"uri", "test.bin"}, {"byteLength", file.buffer.size()}}};
    const Scene scene = load_twice(outside.write("scene/m.gltf", file.document.dump()));
    EXPECT_EQ(scene.meshes[0].indices.size(), 3u) << uri;
    EXPECT_TRUE(scene.textures.empty()) << uri;
    EXPECT_THAT(scene.notes, Contains(AllOf(HasSubstr("images[0]"), HasSubstr("left out")))) << uri;
  }
}

TEST(Doors, BytesThatAreNoTextAreReplacedInEveryName) {
  GltfFile file;
  std::mt19937 random(3);
  std::vector<std::string> marks;
  const auto mark = [&] {
    marks.push_back("MARK" + std::to_string(marks.size()) + "END");
    return marks.back();
  };
  file.document["meshes"][0]["name"] = mark();
  file.document["materials"] = {{{"name", mark()}, {"alphaMode", "BLEND"}}};
  file.primitive()["material"] = 0;
  file.document["nodes"] = {{{"mesh", 0}, {"name", mark()}},
                            {{"camera", 0}},
                            {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  file.document["scenes"][0] = {{"name", mark()}, {"nodes", {0, 1, 2}}};
  file.document["cameras"] = {
      {{"name", mark()}, {"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  file.document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"name", mark()}, {"type", "point"}}};
  file.document["extensionsUsed"] = {"KHR_lights_punctual", mark()};
  file.document["asset"]["generator"] = mark();
  file.document["images"] = {{{"uri", mark()}, {"name", mark()}}};
  file.document["textures"] = {{{"source", 0}, {"name", mark()}}};
  file.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  const TemporaryFolder folder;
  file.write(folder);
  for (int round = 0; round < 60; ++round) {
    std::string text = file.document.dump();
    for (const std::string& name : marks) {
      std::string bytes;
      for (unsigned i = 0; i < 1 + random() % 8; ++i) {
        char byte = static_cast<char>(round % 2 == 0 ? 128 + random() % 128 : random());
        if (static_cast<unsigned char>(byte) < 0x20 || byte == '"' || byte == '\\') byte = 'x';
        bytes += byte;
      }
      text.replace(text.find(name), name.size(), bytes);
    }
    const Scene scene = load_twice(folder.write("name\xe9.gltf", text));
    json names = scene.notes;
    for (const auto& element : scene.meshes) names.push_back(element.name);
    for (const auto& element : scene.materials) names.push_back(element.name);
    for (const auto& element : scene.instances) names.push_back(element.name);
    for (const auto& element : scene.lights) names.push_back(element.name);
    for (const auto& element : scene.cameras) names.push_back(element.name);
    names.push_back(scene.id);
    EXPECT_NO_THROW((void)names.dump());
    if (round % 2 == 0) {
      EXPECT_THAT(scene.notes, Contains(HasSubstr("names have bytes")));
    }
  }
}

TEST(Doors, BytesThatAreNoTextAreReplacedInModelsAndMessages) {
  const TemporaryFolder folder;
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    const auto bytes = [&] {
      std::string text;
      for (unsigned i = 0; i < 1 + random() % 6; ++i)
        text += static_cast<char>(33 + random() % 223);
      return text;
    };
    folder.write("m.mtl", "newmtl " + bytes() + "\nmap_Kd " + bytes() + "\n" + bytes() + "\n");
    const auto file =
        folder.write("m.obj", "mtllib m.mtl\nmtllib " + bytes() + "\no " + bytes() + "\ng " +
                                  bytes() + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl " + bytes() +
                                  "\nf 1 2 3\n" + (round % 2 == 0 ? bytes() : ""));
    try {
      const Scene scene = load_twice(file);
      json names = scene.notes;
      names.push_back(scene.meshes[0].name);
      for (const auto& material : scene.materials) names.push_back(material.name);
      EXPECT_NO_THROW((void)names.dump());
    } catch (const Error& error) {
      EXPECT_NO_THROW((void)json(error.what()).dump());
    }
    const auto document = folder.write(
        "d.json", R"({"penumbra_scene": 1, "title": ")" + bytes() + R"(", ")" + bytes() + "\": 1}");
    try {
      (void)load(document.string());
    } catch (const Error& error) {
      EXPECT_EQ(error.code, "unreadable");
      EXPECT_NO_THROW((void)json({error.what(), error.field}).dump());
    }
  }
}

TEST(Doors, CopiesOfAMeshStandWhereTheyAreSaidToStand) {
  GltfFile file;
  const int moves = file.add(bytes_of<float>({1, 0, 0, 0, 2, 0, 0, 0, 3}), 5126, 3, "VEC3");
  // Half a turn about y, as normalised shorts.
  const int turns =
      file.add(bytes_of<std::int16_t>({0, 0, 0, 32767, 0, 32767, 0, 0, 0, 0, 0, 32767}), 5122, 3,
               "VEC4", true);
  const int scales = file.add(bytes_of<float>({1, 1, 1, 2, 2, 2, 1, 1, 1}), 5126, 3, "VEC3");
  file.document["extensionsUsed"] =
      file.document["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  file.document["nodes"][0]["translation"] = {10, 0, 0};
  file.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", moves}, {"ROTATION", turns}, {"SCALE", scales}};
  const Scene scene = load_twice(file);
  std::vector<glm::dvec3> corners;
  for (const Instance& instance : scene.instances)
    corners.emplace_back(instance.world_from_object * glm::dvec4(1, 0, 0, 1));
  ASSERT_GE(corners.size(), 3u);
  EXPECT_LT(glm::distance(corners[0], glm::dvec3(12, 0, 0)), 1e-6);
  EXPECT_LT(glm::distance(corners[1], glm::dvec3(8, 2, 0)), 1e-6);
  EXPECT_LT(glm::distance(corners[2], glm::dvec3(11, 0, 3)), 1e-6);
  file.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = 1;
  EXPECT_THAT(error_of([&] { load_twice(file); }), HasSubstr("EXT_mesh_gpu_instancing.SCALE"));
}

TEST(Doors, CopiesThatTakeNoBytesOfTheFileAreBounded) {
  GltfFile file;
  file.document["accessors"].push_back(
      {{"componentType", 5126}, {"count", 1 << 24}, {"type", "VEC3"}});
  file.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", 2}};
  EXPECT_THAT(error_of([&] { load_twice(file); }), HasSubstr("more than 1000000 copies"));
}

TEST(Doors, WhatIsLeftOutOrApproximatedIsTold) {
  GltfFile file =
      textured({{"uri", "data:image/png;base64," + base64_encode(png(90))}}, {0, 0, 3, 0, 0, 3});
  file.document["samplers"] = {{{"wrapS", 33071}, {"wrapT", 10497}}};
  file.document["textures"][0]["sampler"] = 0;
  file.document["materials"][0]["normalTexture"]["index"] = 0;
  file.document["materials"][0]["occlusionTexture"]["index"] = 0;
  file.document["materials"][0]["emissiveTexture"]["index"] = 0;
  file.document["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
  file.document["extensionsUsed"] = {"KHR_materials_unlit", "KHR_materials_transmission"};
  file.document["nodes"][0]["skin"] = 0;
  file.document["skins"] = {{{"joints", {0}}}};
  file.document["animations"] = {{{"channels", json::array()}, {"samplers", json::array()}}};
  file.primitive()["targets"] = {{{"POSITION", 0}}};
  const Scene scene = load_twice(file);
  for (const char* told :
       {"repeats instead of", "normal map", "occlusion map", "emissive texture", "unlit",
        "'KHR_materials_transmission' is left out", "skin", "animations", "morph targets"})
    EXPECT_THAT(scene.notes, Contains(HasSubstr(told)));
  // A texture that is used within its borders needs no note.
  GltfFile within = textured({{"uri", "data:image/png;base64," + base64_encode(png(90))}});
  within.document["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  within.document["textures"][0]["sampler"] = 0;
  EXPECT_THAT(load_twice(within).notes, testing::Not(Contains(HasSubstr("repeats"))));
}

TEST(Doors, TexturesAreDecodedOnceAndWithinABound) {
  // Twenty images that are one picture of 256 MiB: more than the bound, were each decoded.
  const std::string big = encode_png(Image8(8192, 8192, 1, 3));
  GltfFile file = textured({{"bufferView", 3}, {"mimeType", "image/png"}});
  file.add(big, 5121, 1, "SCALAR");
  const json image = file.document["images"][0], material = file.document["materials"][0];
  for (int i = 1; i < 20; ++i) {
    file.document["images"].push_back(image);
    file.document["textures"].push_back({{"source", i}});
    file.document["materials"].push_back(material);
    file.document["materials"][static_cast<std::size_t>(i)]["pbrMetallicRoughness"]
                 ["baseColorTexture"]["index"] = i;
  }
  const TemporaryFolder folder;
  const auto once = load(file.write(folder).string());
  EXPECT_EQ(once->textures.size(), 1u);
  EXPECT_EQ(once->materials[19].texture, 0);
  // A store that may take three texels more than one such picture takes no second one.
  Scene scene;
  Notes notes;
  TextureStore store(scene, notes, 4 * 2 * 2 + 12);
  EXPECT_EQ(store.add("a", png(1), "images[0]"), 0);
  EXPECT_EQ(store.add("b", png(1), "images[1]"), 0);
  EXPECT_EQ(store.add("c", png(2), "images[2]"), -1);
  std::vector<std::string> told;
  notes.write_to(told);
  EXPECT_THAT(told, Contains(AllOf(HasSubstr("images[2]: "), HasSubstr("left out"))));
}

TEST(Doors, TexturesOfADocumentAreBoundedTogether) {
  json document = {{"penumbra_scene", 1}, {"textures", json::array()}};
  for (int i = 0; i < 3; ++i)
    document["textures"].push_back({{"generator", "grass"}, {"size", 16}, {"seed", i}});
  document["textures"].push_back({{"png", base64_encode(png(1))}});
  // Three of 1024 bytes and one of 16.
  EXPECT_EQ(read_document(document, {}, 3 * 1024 + 16).textures.size(), 4u);
  EXPECT_THAT(error_of([&] { read_document(document, {}, 3 * 1024 + 15); }),
              HasSubstr("textures[3]"));
  EXPECT_THAT(error_of([&] { read_document(document, {}, 2500); }), HasSubstr("textures[2]"));
}

TEST(Doors, PicturesOfManyChannelsAreRefused) {
  const TemporaryFolder folder;
  const std::string file = (folder.path / "many.tif").string();
  const auto output = OIIO::ImageOutput::create(file);
  const OIIO::ImageSpec spec(64, 64, 200, OIIO::TypeDesc::UINT8);
  ASSERT_TRUE(output && output->open(file, spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, std::vector<char>(64 * 64 * 200).data()));
  output->close();
  EXPECT_THAT(error_of([&] { decode_picture(read_bytes(file)); }), HasSubstr("200 channels"));
  EXPECT_THAT(error_of([] { decode_picture(png(1), 15); }), HasSubstr("MiB that are left"));
}

TEST(Doors, LampsOfAnyScaleComeIn) {
  for (const double intensity : {1e-6, 1e12, 3e15, 1e25}) {
    GltfFile file;
    file.document["nodes"] = {
        {{"mesh", 0}, {"scale", {1e5, 1e5, 1e5}}},
        {{"translation", {0, 3e5, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    file.document["scenes"][0]["nodes"] = {0, 1};
    file.document["extensionsUsed"] = {"KHR_lights_punctual"};
    file.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", intensity}}};
    EXPECT_FLOAT_EQ(load_twice(file).lights[0].intensity, static_cast<float>(intensity));
  }
}

TEST(Doors, NumbersThatAreNotFiniteAreRefusedByElement) {
  for (const float bad : {NAN, INFINITY, -INFINITY})
    for (const char* attribute : {"POSITION", "NORMAL", "TEXCOORD_0", "COLOR_0"}) {
      GltfFile file;
      const bool pair = std::string(attribute) == "TEXCOORD_0";
      std::vector<float> values(pair ? 6 : 9, 0.5f);
      values[4] = bad;
      file.primitive()["attributes"][attribute] =
          file.add(bytes_of(values), 5126, 3, pair ? "VEC2" : "VEC3");
      file.document["meshes"][0]["name"] = "wheel";
      try {
        // A normal is computed anew where it is no direction, and that is told.
        EXPECT_THAT(load_twice(file).notes, Contains(HasSubstr("'wheel'.primitives[0]: normals")));
      } catch (const Error& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("meshes[0] 'wheel'"), HasSubstr("finite")));
      }
    }
}

}  // namespace
}  // namespace penumbra::scenes
