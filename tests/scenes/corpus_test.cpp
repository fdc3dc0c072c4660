#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/library.h"
#include "tests/scenes/gltf_file.h"

namespace penumbra::scenes {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;
using testing::StartsWith;

/// Models of Debian's package assimp-testmodels: good, damaged and hostile ones.
const fs::path corpus = "/usr/share/assimp/models";

TEST(Corpus, EveryModelLoadsOrIsRefusedWithAReason) {
  if (!fs::is_directory(corpus)) GTEST_FAIL() << "the package assimp-testmodels is not installed";
  int loaded = 0, refused = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(corpus)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".gltf" && extension != ".glb" && extension != ".obj") continue;
    try {
      validate(*load(entry.path().string()));
      ++loaded;
    } catch (const Error& error) {
      EXPECT_THAT(error.code, AnyOf("unreadable", "unsupported")) << entry.path();
      EXPECT_THAT(error.what(), StartsWith(entry.path().filename().string() + ": "));
      EXPECT_GT(std::string(error.what()).size(), entry.path().filename().string().size() + 15);
      ++refused;
    }
  }
  EXPECT_GE(loaded, 40);
  EXPECT_GE(refused, 20);
}

TEST(Corpus, VersionOneIsNamed) {
  for (const char* name :
       {"glTF/TwoBoxes/TwoBoxes.gltf", "glTF/BoxTextured-glTF-Binary/BoxTextured.glb"})
    EXPECT_THAT(test::error_of([&] { load((corpus / name).string()); }), HasSubstr("unsupported: "))
        << name;
}

TEST(Corpus, TheSameModelIsTheSameSceneInEveryContainer) {
  const auto hash = [](const char* name) {
    return content_hash(*load((corpus / "glTF2" / name).string()));
  };
  const std::string separate = hash("BoxTextured-glTF/BoxTextured.gltf");
  EXPECT_EQ(hash("BoxTextured-glTF-Binary/BoxTextured.glb"), separate);
  EXPECT_EQ(hash("BoxTextured-glTF-Embedded/BoxTextured.gltf"), separate);
}

TEST(Corpus, TextureTransformsOfTheKhronosTestAreRead) {
  const auto scene = load((corpus / "glTF2/textureTransform/TextureTransformTest.gltf").string());
  EXPECT_GE(scene->textures.size(), 3u);
}

TEST(Corpus, ObjModelsHaveTheirTrianglesAndTextures) {
  // spider.obj: 1368 faces in its 19 groups, all triangles; the ground adds 12.
  const auto spider = load((corpus / "OBJ/spider.obj").string());
  std::size_t triangles = 0;
  for (const Mesh& mesh : spider->meshes) triangles += mesh.indices.size() / 3;
  EXPECT_EQ(triangles, 1368u + 12u);
  // Its material file names five pictures; faces show four of them.
  EXPECT_EQ(spider->textures.size(), 4u);
}

}  // namespace
}  // namespace penumbra::scenes
