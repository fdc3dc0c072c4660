// What happens when files of a running study are changed, or there is no room for them.
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "server/files/durable_file.h"
#include "tests/http/running_server.h"

namespace penumbra::server::http {
namespace {

namespace fs = std::filesystem;

class AnOpenStudy : public RunningServer {
 protected:
  void SetUp() override {
    RunningServer::SetUp();
    researcher->Post(at + "/publish", "", "application/json");
    wait_until("open");
    person = body_of(post(at + "/participants", json::object()), 201, "Enrolment");
  }

  void wait_until(const std::string& status) {
    std::string seen;
    for (int i = 0; i < 500 && seen != status; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      seen = body_of(researcher->Get(at), 200, "Study")["status"];
    }
    ASSERT_EQ(seen, status);
  }

  std::string url(std::size_t page = 0) const {
    return person["pages"][page]["images"][0]["url"].get<std::string>();
  }

  /// File that holds the bytes of a picture.
  fs::path file_with(const std::string& bytes) const {
    for (const auto& entry : fs::directory_iterator(folder.path / "data" / "pictures"))
      if (read_whole(entry.path()) == bytes) return entry.path();
    return {};
  }

  httplib::Result readiness() {
    // Readiness looks at the disk every two seconds at most.
    std::this_thread::sleep_for(std::chrono::milliseconds(2100));
    return httplib::Client("127.0.0.1", server->ops_port()).Get("/readyz");
  }

  /// Damages the file of a picture while its render can still be had, and then without renders.
  void expect_only_right_bytes(const std::function<void(const fs::path&)>& damage) {
    const auto bytes = client->Get(url())->body;
    const auto file = file_with(bytes);
    ASSERT_FALSE(file.empty());
    damage(file);
    const auto again = client->Get(url());
    EXPECT_EQ(again->status, 200);
    EXPECT_EQ(again->body, bytes);
    EXPECT_EQ(read_whole(file), bytes) << "was not put back";

    restart();  // the renders of the tests live in memory: now they are gone
    damage(file);
    const auto refused = client->Get(url());
    EXPECT_EQ(error_of(refused, 503), "storage");
    EXPECT_EQ(refused->body.find(folder.path.string()), std::string::npos) << refused->body;
    const auto state = readiness();
    EXPECT_EQ(state->status, 503);
    EXPECT_NE(state->body.find("pictures"), std::string::npos) << state->body;

    std::ofstream(file, std::ios::binary) << bytes;
    EXPECT_EQ(client->Get(url())->body, bytes);
    EXPECT_EQ(readiness()->status, 200);
  }

  const std::string at = "/api/v1/studies/thesis-2007";
  json person;
};

TEST_F(AnOpenStudy, NeverShowsAnAlteredPicture) {
  expect_only_right_bytes([](const fs::path& file) {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(40);
    bytes.put('\x55');
  });
}

TEST_F(AnOpenStudy, NeverShowsAnEmptiedPicture) {
  expect_only_right_bytes([](const fs::path& file) { fs::resize_file(file, 0); });
}

TEST_F(AnOpenStudy, TellsOfADeletedPicture) {
  expect_only_right_bytes([](const fs::path& file) { fs::remove(file); });
}

TEST_F(AnOpenStudy, IsNotReadyAtStartWhenAPictureIsGone) {
  const auto file = file_with(client->Get(url())->body);
  stop();
  fs::remove(file);
  start();
  EXPECT_EQ(httplib::Client("127.0.0.1", server->ops_port()).Get("/readyz")->status, 503);
}

TEST_F(AnOpenStudy, HasPicturesThatNobodyElseReadsAndNoneHalfWritten) {
  stop();
  const auto pictures = folder.path / "data" / "pictures";
  std::ofstream(pictures / "abc.png.part17-0") << "half";
  const auto before = ::umask(0);
  fs::remove_all(folder.path / "data" / "artefacts");
  start();
  ::umask(before);
  EXPECT_FALSE(fs::exists(pictures / "abc.png.part17-0"));
  EXPECT_EQ(static_cast<unsigned>(fs::status(pictures).permissions()) & 0777u, 0700u);
}

TEST_F(AnOpenStudy, ServesWebPToThoseThatTakeIt) {
  const httplib::Headers takes{{"Accept", "image/avif,image/webp,*/*;q=0.8"}};
  const auto webp = client->Get(url(), takes);
  const auto png = client->Get(url(), httplib::Headers{{"Accept", "image/*"}});
  EXPECT_EQ(webp->get_header_value("Content-Type"), "image/webp");
  EXPECT_EQ(png->get_header_value("Content-Type"), "image/png");
  for (const auto& reply : {&webp, &png}) EXPECT_EQ((*reply)->get_header_value("Vary"), "Accept");
  EXPECT_EQ(webp->body.substr(0, 4) + webp->body.substr(8, 8), "RIFFWEBPVP8L");
}

TEST_F(AnOpenStudy, MakesWebPAgainThatIsAlteredOrGone) {
  const httplib::Headers takes{{"Accept", "image/webp"}};
  const auto bytes = client->Get(url(), takes)->body;
  const auto name = file_with(client->Get(url())->body).stem().string() + ".webp";
  const auto file = folder.path / "data" / "webp" / name;
  const auto kept = read_whole(file);
  ASSERT_TRUE(kept && kept->ends_with(bytes));
  for (const std::size_t place : {std::size_t{0}, kept->size() - 1}) {
    auto altered = *kept;
    altered[place] = static_cast<char>(altered[place] ^ 1);
    std::ofstream(file, std::ios::binary) << altered;
    EXPECT_EQ(client->Get(url(), takes)->body, bytes) << place;
    EXPECT_EQ(read_whole(file), kept) << place << " was not put back";
  }
  fs::remove(file);
  EXPECT_EQ(client->Get(url(), takes)->body, bytes);
  EXPECT_EQ(read_whole(file), kept);
  EXPECT_EQ(static_cast<unsigned>(fs::status(file.parent_path()).permissions()) & 0777u, 0700u);
}

class AStudyWithoutRoom : public AnOpenStudy {
 protected:
  void SetUp() override { RunningServer::SetUp(); }
};

TEST_F(AStudyWithoutRoom, OpensOnceThereIsRoomAgain) {
  const auto pictures = folder.path / "data" / "pictures";
  // A file where the folder was: every picture fails to be stored, as on a full disk.
  fs::remove_all(pictures);
  std::ofstream(pictures) << "in the way";
  researcher->Post(at + "/publish", "", "application/json");
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  EXPECT_EQ(body_of(researcher->Get(at), 200, "Study")["status"], "publishing");
  fs::remove(pictures);
  fs::create_directory(pictures);
  wait_until("open");
}

TEST_F(AStudyWithoutRoom, IsNotReadyWhenNothingCanBeStored) {
  EXPECT_EQ(readiness()->status, 200);
  fs::create_directory(folder.path / "data" / "probe");
  std::ofstream(folder.path / "data" / "probe" / "in the way") << "x";
  const auto state = readiness();
  EXPECT_EQ(state->status, 503);
  EXPECT_EQ(state->body.find(folder.path.string()), std::string::npos) << state->body;
  fs::remove_all(folder.path / "data" / "probe");
  EXPECT_EQ(readiness()->status, 200);
}

TEST_F(AStudyWithoutRoom, CountsWhatStorageDoes) {
  const auto text = httplib::Client("127.0.0.1", server->ops_port()).Get("/metrics")->body;
  for (const std::string name : {"failures", "wal_bytes", "damaged_rows", "damaged_pictures"})
    EXPECT_NE(text.find("penumbra_storage_" + name + " "), std::string::npos) << name;
}

}  // namespace
}  // namespace penumbra::server::http
