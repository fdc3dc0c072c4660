#include <gtest/gtest.h>
#include <zip.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "scenes/export.h"
#include "scenes/library.h"
#include "server/http/png.h"
#include "server/http/scene_upload.h"
#include "server/storage/data_folder.h"
#include "tests/http/running_server.h"
#include "tests/http/zip_files.h"

namespace penumbra::server::http {
namespace {

using Files = std::vector<std::pair<std::string, std::string>>;

class AnArchive : public testing::Test {
 protected:
  void expect_refused(const std::string& zip, const std::string& reason) {
    const auto target = folder.path / "inside" / "deep";
    std::filesystem::remove_all(target);
    std::filesystem::create_directories(target);
    try {
      unpack(zip, target);
      FAIL() << "was unpacked";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, "unreadable");
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path))
      EXPECT_TRUE(entry.path().string().starts_with((folder.path / "inside").string()));
  }
  TemporaryFolder folder;
};

TEST_F(AnArchive, IsUnpackedWithItsFolders) {
  unpack(zip_of(Files{{"a.gltf", "{}"}, {"textures/b.png", "x"}}), folder.path);
  EXPECT_EQ(storage::read_file(folder.path / "a.gltf"), "{}");
  EXPECT_EQ(storage::read_file(folder.path / "textures" / "b.png"), "x");
}

TEST_F(AnArchive, IsRefusedWhereNamesLeadOutside) {
  for (const std::string name : {"../evil", "a/../../evil", "/etc/evil", "a\\..\\evil", "c:evil"})
    expect_refused(zip_of(Files{{name, "x"}}), "names the file");
}

TEST_F(AnArchive, IsRefusedWhenItIsABomb) {
  expect_refused(zip_of(Files{{"a.bin", std::string(32 << 20, '\0')}}), "too tightly");
}

TEST_F(AnArchive, IsRefusedWithTooManyFiles) {
  Files files;
  for (int i = 0; i < 1001; ++i) files.emplace_back(std::to_string(i), "x");
  expect_refused(zip_of(files), "more than 1000 files");
}

TEST_F(AnArchive, IsRefusedWithAnArchiveInside) {
  expect_refused(zip_of(Files{{"a.zip", zip_of(Files{{"b", "x"}})}}), "holds an archive");
}

TEST_F(AnArchive, IsRefusedWithOneNameTwice) {
  for (const Files& files :
       {Files{{"m.glb", "x"}, {"m.glb/inner", "y"}}, Files{{"m.glb/inner", "y"}, {"m.glb", "x"}},
        Files{{"a/b", "x"}, {"a/b/c/d", "y"}}, Files{{"a//b", "x"}, {"a/b", "y"}}})
    expect_refused(zip_of(files), "twice");
}

TEST_F(AnArchive, IsRefusedWithALink) {
  const auto file = folder.path / "link.zip";
  int failure = 0;
  zip_t* zip = zip_open(file.c_str(), ZIP_CREATE, &failure);
  ASSERT_NE(zip, nullptr);
  const std::string target = "/etc/passwd";
  const auto index =
      zip_file_add(zip, "link", zip_source_buffer(zip, target.data(), target.size(), 0), 0);
  zip_file_set_external_attributes(zip, static_cast<zip_uint64_t>(index), 0, ZIP_OPSYS_UNIX,
                                   0120777u << 16);
  ASSERT_EQ(zip_close(zip), 0);
  const auto bytes = storage::read_file(file);
  std::filesystem::remove(file);
  expect_refused(bytes, "holds a link");
}

TEST_F(AnArchive, IsRefusedWhenItIsCutShort) {
  const auto zip = zip_of(Files{{"a.gltf", std::string(5000, 'x')}});
  expect_refused(zip.substr(0, zip.size() / 2), "damaged");
}

TEST(PixelsOnly, KeepsThePictureAndNothingElse) {
  const auto png = pixels_only(grey_png(100, "secret technique"));
  EXPECT_EQ(chunk_types(png), (std::vector<std::string>{"IHDR", "IDAT", "IEND"}));
  EXPECT_EQ(png, pixels_only(grey_png(100, "another")));
  EXPECT_NE(png, pixels_only(grey_png(101, "another")));
}

TEST(PixelsOnly, RefusesWhatIsCutShort) {
  const auto png = grey_png(100, "x");
  for (std::size_t length = 0; length < png.size(); ++length)
    EXPECT_THROW(pixels_only(png.substr(0, length)), Error) << length;
}

using UploadedScenes = RunningServer;

TEST_F(UploadedScenes, NeedAnIdThatIsOne) {
  for (const std::string id : {"..", "%2e%2e", "A", "a%20b", "-a", "a%2fb"}) {
    const auto result = researcher->Put("/api/v1/scenes/" + id, "{}", "application/json");
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->status == 400 || result->status == 404) << id << result->body;
  }
  EXPECT_EQ(error_of(researcher->Put("/api/v1/scenes/boxes", "{}", "application/json"), 409),
            "conflict");
  EXPECT_EQ(error_of(researcher->Delete("/api/v1/scenes/boxes"), 409), "conflict");
  EXPECT_EQ(error_of(researcher->Delete("/api/v1/scenes/unknown"), 404), "not_found");
}

TEST_F(UploadedScenes, AreListedReplacedAndRemoved) {
  const auto glb = scenes::encode_glb(*scenes::load("sweep:2x50x1"));
  const auto put = [&](const std::string& bytes) {
    return researcher->Put("/api/v1/scenes/mine", bytes, "model/gltf-binary");
  };
  EXPECT_EQ(body_of(put(glb), 201, "Scene")["id"], "mine");
  body_of(put(zip_of(Files{{"folder/any.glb", glb}})), 200, "Scene");
  const auto listed = [&] {
    const auto list = body_of(client->Get("/api/v1/scenes"), 200, "SceneList");
    std::vector<std::string> imported;
    for (const auto& scene : list["scenes"])
      if (!scene["built_in"].get<bool>()) imported.push_back(scene["id"]);
    return imported;
  };
  EXPECT_EQ(listed(), std::vector<std::string>{"mine"});
  EXPECT_EQ(scenes::content_hash(*scenes::load("mine", folder.path / "data")),
            scenes::content_hash(*scenes::load("sweep:2x50x1")));
  EXPECT_EQ(researcher->Delete("/api/v1/scenes/mine")->status, 204);
  EXPECT_TRUE(listed().empty());
}

TEST_F(UploadedScenes, ThatWereImportedAsAFileAreReplacedToo) {
  const auto data = folder.path / "data";
  std::filesystem::create_directories(data / "scenes");
  scenes::export_glb(*scenes::load("sweep:2x50x1"), data / "scenes" / "mine.glb");
  const auto other = scenes::encode_glb(*scenes::load("sweep:3x50x1"));
  body_of(researcher->Put("/api/v1/scenes/mine", other, "model/gltf-binary"), 200, "Scene");
  EXPECT_EQ(scenes::content_hash(*scenes::load("mine", data)),
            scenes::content_hash(*scenes::load("sweep:3x50x1")));
}

TEST_F(UploadedScenes, ComeInAsTheCommandLineTakesThem) {
  const std::string obj =
      "# a box's lid\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nl 1 2\nf 1 2 3 4\n";
  const std::string gltf = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],
      "nodes":[{"mesh":0,"skin":0}],"skins":[{"joints":[0]}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
      "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,
      "uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  const std::vector<std::pair<std::string, std::string>> bodies{
      {obj, "gone.mtl"},
      {gltf, "skin"},
      {zip_of(Files{{"deep/m.obj", obj}, {"deep/gone.mtl", "newmtl a\nKd 1 0 0\n"}}), "is a line"},
      {zip_of(Files{{"m.gltf", gltf}, {"readme.txt", "hello"}}), "skin"}};
  int status = 201;
  for (const auto& [bytes, note] : bodies) {
    const auto put = body_of(
        researcher->Put("/api/v1/scenes/mine", bytes, "application/octet-stream"), status, "Scene");
    status = 200;
    const auto got = body_of(client->Get("/api/v1/scenes/mine"), 200, "Scene");
    const auto list = body_of(client->Get("/api/v1/scenes"), 200, "SceneList");
    for (const auto& scene : {put, got, list["scenes"].back()}) {
      EXPECT_EQ(scene["id"], "mine");
      EXPECT_NE(scene["notes"].dump().find(note), std::string::npos) << scene.dump();
    }
    EXPECT_NO_THROW(scenes::load("mine", folder.path / "data"));
  }
  EXPECT_EQ(error_of(client->Get("/api/v1/scenes/nothing"), 404), "not_found");
}

TEST_F(UploadedScenes, AreKeptWhereTheNewOneCannotBeRead) {
  const auto glb = scenes::encode_glb(*scenes::load("sweep:2x50x1"));
  body_of(researcher->Put("/api/v1/scenes/mine", glb, "model/gltf-binary"), 201, "Scene");
  const auto broken =
      researcher->Put("/api/v1/scenes/mine", glb.substr(0, glb.size() / 2), "model/gltf-binary");
  EXPECT_EQ(error_of(broken, 422), "unreadable");
  EXPECT_EQ(broken->body.find(folder.path.string()), std::string::npos) << broken->body;
  EXPECT_NO_THROW(scenes::load("mine", folder.path / "data"));
}

TEST_F(UploadedScenes, MayComeAtTheSameTimeUnderOneId) {
  const auto glb = scenes::encode_glb(*scenes::load("sweep:2x50x1"));
  std::atomic<int> stored = 0;
  std::vector<std::thread> senders;
  for (int i = 0; i < 8; ++i)
    senders.emplace_back([&] {
      httplib::Client sender("127.0.0.1", server->port());
      sender.set_read_timeout(120);
      sender.set_bearer_token_auth(server->token());
      const auto result = sender.Put("/api/v1/scenes/mine", glb, "model/gltf-binary");
      if (result && (result->status == 200 || result->status == 201)) ++stored;
    });
  for (std::thread& sender : senders) sender.join();
  EXPECT_EQ(stored, 8);
  EXPECT_NO_THROW(scenes::load("mine", folder.path / "data"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path / "data" / "incoming"));
}

TEST_F(UploadedScenes, ThatAStopInterruptedAreSweptAtTheNextStart) {
  stop();
  std::filesystem::create_directories(folder.path / "data" / "incoming" / "left" / "scene");
  start();
  EXPECT_TRUE(std::filesystem::is_empty(folder.path / "data" / "incoming"));
}

/// The process that reads uploads is a script that does as the file says.
class BadReaders : public RunningServer {
 protected:
  void adjust(ServeOptions& served) override {
    const auto script = folder.path / "reader";
    // The file's name is its last argument; a scene document may hold any text.
    std::ofstream(script) << "#!/bin/sh\nfor last; do :; done\n"
                             "case $(cat \"$last\") in\n"
                             "*crash*) kill -SEGV $$;;\n"
                             "*hang*) exec sleep 600;;\n"
                             "*chatter*) exec yes;;\n"
                             "esac\n"
                             "echo '{\"scene\":{\"title\":\"Read\",\"notes\":[]}}'\n";
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    served.worker_command = {script};
    served.import_deadline_s = 1.0;
  }

  httplib::Result put(const std::string& id, const std::string& document) {
    return researcher->Put("/api/v1/scenes/" + id, document, "application/json");
  }
};

TEST_F(BadReaders, CostTheirUploadAndNothingElse) {
  EXPECT_EQ(body_of(put("mine", "{}"), 201, "Scene")["title"], "Read");
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(error_of(put("mine", R"({"it": "crash"})"), 422), "unreadable");
  EXPECT_EQ(error_of(put("mine", R"({"it": "hang"})"), 504), "deadline");
  EXPECT_EQ(error_of(put("mine", R"({"it": "chatter"})"), 422), "unreadable");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  EXPECT_EQ(storage::read_file(folder.path / "data" / "scenes" / "mine" / "scene.json"), "{}");
  EXPECT_EQ(body_of(put("mine", "{ }"), 200, "Scene")["title"], "Read");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path / "data" / "incoming"));
}

TEST_F(UploadedScenes, ThatCannotBeReadLeaveNothingBehind) {
  for (const std::string body : {"", "nonsense", "glTF\2\0\0\0", "PK\3\4broken"}) {
    const auto result = researcher->Put("/api/v1/scenes/mine", body, "application/octet-stream");
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->status == 422 || result->status == 400) << result->status << result->body;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path / "data" / "scenes" / "mine"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path / "data" / "incoming"));
}

}  // namespace
}  // namespace penumbra::server::http
