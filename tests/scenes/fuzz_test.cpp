#include <gtest/gtest.h>

#include <random>

#include "scenes/document.h"
#include "scenes/export.h"
#include "scenes/library.h"
#include "tests/scenes/gltf_file.h"

namespace penumbra::scenes {
namespace {

using test::GltfFile;
using test::TemporaryFolder;

/// Loads bytes as a file of this name; anything but a scene or an Error ends the program.
void survive(const TemporaryFolder& folder, const std::string& name, const std::string& bytes) {
  const auto file = folder.write(name, bytes);
  try {
    validate(*load(file.string()));
  } catch (const Error& error) {
    EXPECT_TRUE(error.code == "unreadable" || error.code == "unsupported")
        << error.code << ": " << error.what();
  }
}

/// Small scene with a texture, a camera, a light and several meshes.
std::string small_glb() {
  Scene scene = *load("half-plane");
  scene.textures.push_back({"two", 2, 1, {255, 0, 0, 255, 0, 255, 0, 255}});
  scene.materials[0].texture = 0;
  return encode_glb(scene);
}

/// Copies of the bytes with a few random changes: bits flipped, bytes replaced, parts removed.
template <class Action>
void bend(const std::string& bytes, int rounds, const Action& action) {
  std::mt19937 random(20071122);
  for (int round = 0; round < rounds; ++round) {
    std::string bent = bytes;
    for (unsigned i = 0; i <= random() % 4; ++i) {
      const std::size_t at = random() % bent.size();
      switch (random() % 4) {
        case 0:
          bent[at] = static_cast<char>(bent[at] ^ (1 << random() % 8));
          break;
        case 1:
          bent[at] = static_cast<char>(random());
          break;
        case 2:
          bent[at] = "0123456789-\"{}[]"[random() % 16];
          break;
        default:
          bent.erase(at, random() % 8);
      }
      if (bent.empty()) bent = " ";
    }
    action(bent);
  }
}

TEST(DamagedFiles, CutOffBinariesNeverCrash) {
  const TemporaryFolder folder;
  const std::string bytes = small_glb();
  for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 150)
    survive(folder, "cut.glb", bytes.substr(0, length));
}

TEST(DamagedFiles, BentBinariesNeverCrash) {
  const TemporaryFolder folder;
  const std::string bytes = small_glb();
  bend(bytes, 400, [&](const std::string& bent) { survive(folder, "bent.glb", bent); });
  // The same with the sizes in the header put right, so that the damage reaches the parts behind
  // it.
  const std::size_t json_end = 20 + std::size_t{static_cast<unsigned char>(bytes[12])} +
                               (std::size_t{static_cast<unsigned char>(bytes[13])} << 8);
  std::mt19937 random(42);
  for (int round = 0; round < 400; ++round) {
    std::string bent = bytes;
    for (int i = 0; i < 3; ++i)
      bent[20 + random() % (json_end - 20)] = "0123456789-\"{}[]:,e."[random() % 20];
    survive(folder, "bent.glb", bent);
  }
}

TEST(DamagedFiles, BentNumbersInTextFilesNeverCrash) {
  const TemporaryFolder folder;
  GltfFile file;
  file.write(folder);
  const std::string text = file.document.dump();
  // Every number of the document in turn becomes one that does not fit.
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (std::isdigit(static_cast<unsigned char>(text[at])) == 0) continue;
    std::size_t end = at;
    while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) ++end;
    for (const char* number :
         {"-1", "4294967295", "9223372036854775807", "1e300", "0.5", "null", "[]"})
      survive(folder, "numbers.gltf", text.substr(0, at) + number + text.substr(end));
    at = end;
  }
}

TEST(DamagedFiles, BentDocumentsNeverCrash) {
  const TemporaryFolder folder;
  Scene scene = *load("half-plane");
  const std::string text = write_document(scene).dump();
  bend(text, 400, [&](const std::string& bent) { survive(folder, "bent.json", bent); });
  for (std::size_t length = 0; length < text.size(); length += 1 + text.size() / 100)
    survive(folder, "cut.json", text.substr(0, length));
}

TEST(DamagedFiles, BentObjModelsNeverCrash) {
  const TemporaryFolder folder;
  const std::string text =
      "mtllib missing.mtl\no square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nusemtl "
      "red\n"
      "f 1/1/1 2/1/1 3/1/1 4/1/1\nf -1 -2 -3\n";
  survive(folder, "whole.obj", text);
  bend(text, 600, [&](const std::string& bent) { survive(folder, "bent.obj", bent); });
}

}  // namespace
}  // namespace penumbra::scenes
