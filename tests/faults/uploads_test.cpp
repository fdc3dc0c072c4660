// Files that strangers send.
#include <openssl/evp.h>
#include <zip.h>
#include <zlib.h>

#include <limits>
#include <thread>

#include "tests/faults/ledger.h"
#include "tests/faults/people.h"
#include "tests/scenes/gltf_file.h"

namespace penumbra::faults {
namespace {

namespace fs = std::filesystem;
using scenes::test::GltfFile;

/// Entries of a zip archive: name, content, Unix mode (0: none).
struct Packed {
  std::string name;
  std::string content;
  unsigned mode = 0;
};

std::string zip_of(const std::vector<Packed>& entries, bool store = false) {
  const server::TemporaryFolder folder;
  const auto file = folder.path / "x.zip";
  int failure = 0;
  zip_t* archive = zip_open(file.c_str(), ZIP_CREATE, &failure);
  for (const auto& entry : entries) {
    zip_source_t* source =
        zip_source_buffer(archive, entry.content.data(), entry.content.size(), 0);
    const auto index = zip_file_add(archive, entry.name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (store) zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0);
    if (entry.mode != 0)
      zip_file_set_external_attributes(archive, static_cast<zip_uint64_t>(index), 0, ZIP_OPSYS_UNIX,
                                       entry.mode << 16);
  }
  zip_close(archive);
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

std::string base64_of(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3), '\0');
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                  reinterpret_cast<const unsigned char*>(bytes.data()),
                  static_cast<int>(bytes.size()));
  return text;
}

/// One server for all of them.
class Uploads : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<server::TemporaryFolder>();
    ServerOptions options;
    options.data = folder->path / "data";
    server = std::make_unique<ServerProcess>(options);
  }
  static void TearDownTestSuite() {
    server.reset();
    folder.reset();
  }
  void SetUp() override { server->forget_peak(); }

  static httplib::Result put(const std::string& id, const std::string& bytes) {
    return server->researcher().Put("/api/v1/scenes/" + id, bytes, "application/octet-stream");
  }
  /// Uploads and expects a refusal that says why; the message.
  static std::string refused(const std::string& bytes, const std::string& what) {
    const auto result = put("mine", bytes);
    EXPECT_TRUE(result) << what << server->log();
    if (!result) return "";
    EXPECT_EQ(result->status, 422) << what << ": " << result->body;
    return result->body;
  }
  /// The document with its buffer inside.
  static json embedded(const GltfFile& file) {
    json document = file.document;
    document["buffers"] = {
        {{"byteLength", file.buffer.size()},
         {"uri", "data:application/octet-stream;base64," + base64_of(file.buffer)}}};
    return document;
  }
  /// In an archive, as a .gltf file.
  static std::string packed(const json& document) {
    return zip_of({{"scene.gltf", document.dump()}});
  }

  static std::unique_ptr<server::TemporaryFolder> folder;
  static std::unique_ptr<ServerProcess> server;
};
std::unique_ptr<server::TemporaryFolder> Uploads::folder;
std::unique_ptr<ServerProcess> Uploads::server;

TEST_F(Uploads, AGoodOneIsTaken) {
  const auto result = put("good", packed(embedded(GltfFile())));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 201) << result->body;
}

TEST_F(Uploads, NamesLeadNowhere) {
  Fault fault(33, "ids and paths with ../, %2e, NUL, links");
  const auto good = packed(embedded(GltfFile()));
  for (const std::string id : {"..%2fx", "%2e%2e", "a%00b", "..", "%2e%2e%2f%2e%2e%2fetc", "A",
                               "a/b", "a%5cb", "-a", "%c0%ae"}) {
    ++fault.tries;
    const auto result = put(id, good);
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->status == 400 || result->status == 404) << id << result->status;
  }
  for (const std::string path :
       {"/assets/..%2f..%2fpenumbra.sqlite", "/assets/%2e%2e/researcher.token",
        "/assets/participant/../../researcher.token", "/s/..%2fresearcher.token", "/assets/%00"}) {
    ++fault.tries;
    const auto result = server->client().Get(path);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 404) << path;
  }
  EXPECT_FALSE(fs::exists(folder->path / "x"));
  fault.did << "refused";
}

TEST_F(Uploads, ArchivesStayInTheirFolder) {
  Fault fault(34, "zip archives: slip, links, bombs, nesting, counts, lying sizes");
  const auto gltf = embedded(GltfFile()).dump();
  for (const std::string name : {"../beside.txt", "/tmp/beside.txt", "a/../../beside.txt",
                                 "..\\beside.txt", "c:beside.txt"}) {
    ++fault.tries;
    refused(zip_of({{"scene.gltf", gltf}, {name, "x"}}), name);
  }
  ++fault.tries;
  refused(zip_of({{"scene.gltf", gltf}, {"link.png", "/etc/passwd", 0120777}}), "a link");
  ++fault.tries;
  refused(zip_of({{"scene.gltf", gltf}, {"zeros.bin", std::string(64 << 20, '\0')}}), "a bomb");
  ++fault.tries;
  refused(zip_of({{"scene.gltf", gltf}, {"inner.zip", zip_of({{"a", "b"}})}}), "nesting");
  ++fault.tries;
  std::vector<Packed> many = {{"scene.gltf", gltf}};
  for (int i = 0; i < 1200; ++i) many.push_back({"f" + std::to_string(i), "x"});
  refused(zip_of(many, true), "1,200 files");
  ++fault.tries;
  refused(zip_of({{"a.gltf", gltf}, {"b.gltf", gltf}}), "two scenes");
  ++fault.tries;
  refused(zip_of({{"scene.glb/x", "y"}, {"scene.glb", "x"}}, true),
          "a file and a folder of one name");
  ++fault.tries;
  auto lying = zip_of({{"scene.gltf", std::string(5000, ' ') + gltf}}, true);
  for (std::size_t at = 0; (at = lying.find("PK\x01\x02", at)) != std::string::npos; at += 4)
    lying[at + 24] = 10;  // the uncompressed size in the central directory
  refused(lying, "a size that lies");
  ++fault.tries;
  refused(zip_of({{"scene.gltf", gltf}}).substr(0, 200), "cut off");
  EXPECT_FALSE(fs::exists(folder->path / "beside.txt"));
  EXPECT_FALSE(fs::exists("/tmp/beside.txt"));
  EXPECT_LT(server->peak(), 400u << 20);
  fault.did << "each 422; the server's memory at most " << (server->peak() >> 20) << " MiB";
}

TEST_F(Uploads, NodesInRingsAndDeepChainsAreRefused) {
  Fault fault(35, "cyclic nodes, two parents, chains of 100,000");
  auto ring = embedded(GltfFile());
  ring["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
  ++fault.tries;
  refused(packed(ring), "a ring");
  auto self = embedded(GltfFile());
  self["nodes"] = {{{"children", {0}}, {"mesh", 0}}};
  ++fault.tries;
  refused(packed(self), "its own child");
  auto shared = embedded(GltfFile());
  shared["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
  shared["scenes"] = {{{"nodes", {0, 1}}}};
  ++fault.tries;
  refused(packed(shared), "two parents");
  auto deep = embedded(GltfFile());
  deep["nodes"] = json::array();
  for (int i = 0; i < 100000; ++i) deep["nodes"].push_back({{"children", {i + 1}}});
  deep["nodes"].push_back({{"mesh", 0}});
  ++fault.tries;
  refused(packed(deep), "a chain");
  fault.did << "each 422, no stack overflow";
}

TEST_F(Uploads, AccessorsOutsideTheirBuffersAreRefused) {
  Fault fault(36, "counts near 2^62, offsets that wrap, sparse indices outside, bad strides");
  const auto bent = [&](const std::string& what, const std::function<void(json&)>& bend) {
    auto document = embedded(GltfFile());
    bend(document);
    ++fault.tries;
    refused(packed(document), what);
  };
  for (const std::int64_t count : {std::int64_t{1} << 62, std::int64_t{1} << 40, std::int64_t{4}})
    bent("count", [&](json& d) { d["accessors"][0]["count"] = count; });
  bent("accessor offset",
       [](json& d) { d["accessors"][0]["byteOffset"] = (std::int64_t{1} << 62); });
  bent("view offset", [](json& d) { d["bufferViews"][0]["byteOffset"] = (std::int64_t{1} << 62); });
  bent("view length", [](json& d) { d["bufferViews"][0]["byteLength"] = (std::int64_t{1} << 62); });
  bent("sum that wraps", [](json& d) {
    d["bufferViews"][0]["byteOffset"] = std::numeric_limits<std::int64_t>::max() - 8;
    d["bufferViews"][0]["byteLength"] = 36;
  });
  bent("view of no buffer", [](json& d) { d["bufferViews"][0]["buffer"] = 7; });
  bent("accessor of no view", [](json& d) { d["accessors"][0]["bufferView"] = 99; });
  bent("sparse index outside", [](json& d) {
    d["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", 1}, {"componentType", 5123}, {"byteOffset", 4}}},
        {"values", {{"bufferView", 0}}}};
    d["accessors"][0]["count"] = 2;
  });
  bent("sparse count", [](json& d) {
    d["accessors"][0]["sparse"] = {{"count", 1 << 30},
                                   {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                                   {"values", {{"bufferView", 0}}}};
  });
  bent("component type", [](json& d) { d["accessors"][0]["componentType"] = 1234; });
  fault.did << "each 422";
}

TEST_F(Uploads, IndicesOutsideTheirArraysAreRefused) {
  Fault fault(37, "indices of vertices, nodes, meshes, materials out of range");
  const auto bent = [&](const std::string& what, const std::function<void(json&)>& bend) {
    auto document = embedded(GltfFile());
    bend(document);
    ++fault.tries;
    refused(packed(document), what);
  };
  GltfFile far;
  const int indices =
      far.add(scenes::test::bytes_of<std::uint16_t>({0, 1, 65000}), 5123, 3, "SCALAR");
  far.document["meshes"][0]["primitives"][0]["indices"] = indices;
  ++fault.tries;
  refused(packed(embedded(far)), "vertex 65,000");
  bent("mesh", [](json& d) { d["nodes"][0]["mesh"] = 5; });
  bent("child", [](json& d) { d["nodes"][0]["children"] = {17}; });
  bent("material", [](json& d) { d["meshes"][0]["primitives"][0]["material"] = 3; });
  bent("accessor", [](json& d) { d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 44; });
  bent("indices", [](json& d) { d["meshes"][0]["primitives"][0]["indices"] = 7; });
  fault.did << "each 422";
}

TEST_F(Uploads, AddressesAreNeverOpened) {
  Fault fault(38, "file:, http: and ../ addresses in uploads");
  // A listener that must hear nothing.
  httplib::Server listener;
  std::atomic<int> heard = 0;
  listener.Get(".*", [&](const httplib::Request&, httplib::Response&) { ++heard; });
  const int port = listener.bind_to_any_port("127.0.0.1");
  std::thread thread([&] { listener.listen_after_bind(); });
  const std::string secret = "a secret that lies beside the data";
  std::ofstream(folder->path / "secret.bin") << secret << std::string(100, ' ');
  for (const std::string& uri :
       {"http://127.0.0.1:" + std::to_string(port) + "/x.bin",
        "file://" + (folder->path / "secret.bin").string(), (folder->path / "secret.bin").string(),
        std::string("../../../secret.bin"), std::string("%2e%2e/%2e%2e/secret.bin"),
        std::string("..\\secret.bin"), std::string("/proc/self/environ")}) {
    auto document = embedded(GltfFile());
    document["buffers"][0]["uri"] = uri;
    ++fault.tries;
    const auto message = refused(packed(document), uri);
    EXPECT_EQ(message.find(secret), std::string::npos);
    // As an image: refused, or left out with a note.
    auto textured = embedded(GltfFile());
    textured["images"] = {{{"uri", uri}}};
    textured["textures"] = {{{"source", 0}}};
    textured["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    textured["meshes"][0]["primitives"][0]["material"] = 0;
    ++fault.tries;
    const auto result = put("mine", packed(textured));
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->status == 422 || result->status == 200 || result->status == 201)
        << uri << result->body;
    if (result->status != 422) {
      EXPECT_FALSE(json::parse(result->body)["notes"].empty()) << uri;
    }
  }
  listener.stop();
  thread.join();
  EXPECT_EQ(heard, 0);
  fault.did << "no connection, nothing from outside the upload";
}

/// Big-endian number of four bytes.
std::string four(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
  return bytes;
}

TEST_F(Uploads, PicturesThatLieAboutTheirSizeAreLeftOut) {
  Fault fault(39, "pictures: a header of 2^31 pixels, a JPEG cut off, no picture at all");
  std::string header =
      "IHDR" + four(0x7fffffff) + four(0x7fffffff) + std::string("\x08\x02\0\0\0", 5);
  const auto check =
      crc32(0, reinterpret_cast<const Bytef*>(header.data()), static_cast<uInt>(header.size()));
  const std::string huge = "\x89PNG\r\n\x1a\n" + four(13) + header +
                           four(static_cast<std::uint32_t>(check)) + four(0) + "IDAT" +
                           four(0x35af061e);
  const std::string cut("\xff\xd8\xff\xe0\0\x10JFIF\0\x01\x01\0\0\x01\0\x01\0\0\xff\xdb", 22);
  for (const auto& [name, bytes] : {std::pair<std::string, std::string>{"huge.png", huge},
                                    {"cut.jpg", cut},
                                    {"none.png", "no picture"}}) {
    auto document = embedded(GltfFile());
    document["images"] = {{{"uri", name}}};
    document["textures"] = {{{"source", 0}}};
    document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    document["meshes"][0]["primitives"][0]["material"] = 0;
    ++fault.tries;
    // The geometry is drawn without; a note names the picture.
    const auto result = put("mine", zip_of({{"scene.gltf", document.dump()}, {name, bytes}}));
    ASSERT_TRUE(result) << name;
    EXPECT_LE(result->status, 201) << name << ": " << result->body;
    EXPECT_NE(result->body.find("images[0]"), std::string::npos) << result->body;
  }
  EXPECT_LT(server->peak(), 400u << 20);
  fault.did << "each left out with a note, at most " << (server->peak() >> 20)
            << " MiB in the server";
}

TEST_F(Uploads, ManyUploadsOfOneIdAtOnceEndWithOneOfThem) {
  Fault fault(0, "8 uploads of one id at once, 5 times");
  const auto bytes = packed(embedded(GltfFile()));
  std::atomic<int> failures = 0;
  for (int round = 0; round < 5; ++round) {
    std::vector<std::thread> people;
    for (int i = 0; i < 8; ++i)
      people.emplace_back([&] {
        const auto result = put("contested", bytes);
        if (!result || (result->status >= 500 && result->status != 503)) ++failures;
      });
    for (auto& person : people) person.join();
    fault.tries += 8;
  }
  EXPECT_EQ(failures, 0);
  const auto plan = server->client().Get("/api/v1/plan?scene=contested&technique=none");
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->status, 200) << plan->body;
  fault.did << "no failure, the scene is whole";
}

}  // namespace
}  // namespace penumbra::faults
