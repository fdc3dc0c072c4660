// What is stored is damaged, or cannot be stored: told, and never shown as sound.
#include <sqlite3.h>
#include <sys/stat.h>

#include <algorithm>
#include <random>
#include <set>

#include "tests/faults/answering.h"
#include "tests/faults/broken_system.h"
#include "tests/faults/ledger.h"

namespace penumbra::faults {
namespace {

namespace fs = std::filesystem;
using Damage = WithStudy;

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

void write(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// Rows of an export as a set, without the header.
std::set<std::string> rows_of(const std::string& csv) {
  std::set<std::string> rows;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) rows.insert(line);
  return rows;
}

/// A data folder with answers, and what its export says.
class WithAnswers : public Damage {
 protected:
  void SetUp() override {
    Damage::SetUp();
    ServerProcess server(options());
    Answering people(server, enter_many(server, 40), 8);
    people.finish();
    csv = export_of(server);
    ASSERT_GT(rows_of(csv).size(), 200u);
    ASSERT_EQ(server.terminate(), 0);
    original = folder.path / "original";
    fs::copy(data, original, fs::copy_options::recursive);
  }

  static std::string export_of(const ServerProcess& server) {
    const auto result = server.researcher().Get(study_at + "/responses.csv");
    return result && result->status == 200 ? result->body : "";
  }
  void restore() {
    fs::remove_all(data);
    fs::copy(original, data, fs::copy_options::recursive);
  }

  /// Starts on the damaged folder. True where the damage does harm: a server that says ready hands
  /// out an export that differs from the truth, or lacks rows without a word.
  bool deceives(std::string* how = nullptr) {
    ServerProcess server(options());
    if (!server.running()) return false;
    const auto now = export_of(server);
    const bool ready = server.ready() == 200;
    if (how != nullptr) *how = ready ? "ready" : "not ready";
    return ready && !now.empty() && rows_of(now) != rows_of(csv);
  }

  /// One digit of the first answer.
  void alter_an_answer() {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((data / "penumbra.sqlite").c_str(), &database), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(database,
                           "UPDATE answers SET body = replace(body, '\"difficulty\":3', "
                           "'\"difficulty\":4') WHERE id = (SELECT MIN(id) FROM answers)",
                           nullptr, nullptr, nullptr),
              SQLITE_OK);
    ASSERT_EQ(sqlite3_changes(database), 1);
    sqlite3_close(database);
  }

  void flip_bits(int tries, Fault& fault, unsigned seed) {
    std::mt19937 random(seed);
    int told = 0;
    for (int i = 0; i < tries; ++i) {
      restore();
      auto bytes = bytes_of(data / "penumbra.sqlite");
      for (int bit = 0; bit < 8; ++bit) {
        const auto at = random() % bytes.size();
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
      }
      write(data / "penumbra.sqlite", bytes);
      ++fault.tries;
      std::string how;
      EXPECT_FALSE(deceives(&how)) << "flip " << i;
      if (how != "ready") ++told;
    }
    fault.did << told << " of " << tries << " files told as damaged, the others did no harm: no "
              << "altered export from a server that said ready";
  }

  std::string csv;
  fs::path original;
};

TEST_F(WithAnswers, FlippedBitsNeverPassForSound) {
  Fault fault(7, "8 random bits of the database flipped");
  flip_bits(8, fault, 1);
}

TEST_F(WithAnswers, LongFlippedBitsNeverPassForSound) {
  Fault fault(7, "8 random bits of the database flipped, many times");
  flip_bits(200, fault, 2);
}

TEST_F(WithAnswers, AnAlteredAnswerIsTold) {
  Fault fault(7, "one digit of an answer changed");
  ++fault.tries;
  alter_an_answer();
  std::string how;
  EXPECT_FALSE(deceives(&how));
  fault.did << "the server is " << how;
}

TEST_F(WithAnswers, ARepairedFolderIsServedAgain) {
  Fault fault(7, "an altered answer and an altered picture, repaired");
  alter_an_answer();
  const auto picture = fs::directory_iterator(data / "pictures")->path();
  const auto truth = bytes_of(picture);
  write(picture, "altered");
  ++fault.tries;
  {
    ServerProcess server(options());
    EXPECT_EQ(server.ready(), 503);
    EXPECT_EQ(run_program({"repair", "--data", data.string()}).status, 1);  // it is in use
  }
  const auto repaired = run_program({"repair", "--data", data.string()});
  EXPECT_EQ(repaired.status, 0) << repaired.output;
  EXPECT_EQ(run_program({"verify", "--data", data.string()}).status, 0);
  EXPECT_EQ(bytes_of(picture), truth);
  ServerProcess server(options());
  EXPECT_EQ(server.ready(), 200);
  // Flags compare a person with all others: they are no part of what was answered.
  const auto answered = [](const std::string& text) {
    std::set<std::string> rows;
    for (const auto& row : rows_of(text)) rows.insert(row.substr(0, row.find(",FALSE,")));
    return rows;
  };
  const auto before = answered(csv);
  const auto after = answered(export_of(server));
  EXPECT_EQ(after.size(), before.size() - 3);  // the three pictures of one page
  EXPECT_TRUE(std::includes(before.begin(), before.end(), after.begin(), after.end()));
  auto client = server.client();
  const auto person = enter(client);
  EXPECT_EQ(client.Put(person.page(0), person.answer(0, random_uuid()).dump(), "application/json")
                ->status,
            200);
  fault.did << "one answer moved aside, the others as they were, the picture drawn again";
}

TEST_F(WithAnswers, AnEmptyDatabaseBesidePicturesIsRefused) {
  Fault fault(7, "the database is empty, or gone, beside pictures");
  for (const bool gone : {false, true}) {
    restore();
    ++fault.tries;
    for (const char* name : {"penumbra.sqlite", "penumbra.sqlite-wal", "penumbra.sqlite-shm"})
      fs::remove(data / name);
    if (!gone) write(data / "penumbra.sqlite", "");
    ServerProcess server(options());
    EXPECT_TRUE(!server.running() || server.ready() == 503) << gone;
    if (server.running()) {
      auto client = server.client();
      EXPECT_TRUE(enter(client).token.empty());
    }
  }
  fault.did << "refused, or not ready";
}

TEST_F(Damage, AFlippedByteOfTheLogIsTold) {
  Fault fault(7, "one byte of the write-ahead log flipped after a kill");
  ServerProcess server(options());
  Answering people(server, enter_many(server, 20), 4);
  people.finish();
  server.kill();
  const auto wal = data / "penumbra.sqlite-wal";
  auto bytes = bytes_of(wal);
  ASSERT_GT(bytes.size(), 10000u);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 16);
  write(wal, bytes);
  server.start();
  ++fault.tries;
  const bool told = !server.running() || server.ready() == 503;
  const int lost = server.running() ? people.acknowledged().lost(server) : 0;
  EXPECT_TRUE(told || lost == 0) << lost;
  fault.did << (told ? "told: not ready" : "nothing was lost");
}

/// Bytes of every picture that a person sees, or the states that came instead.
std::vector<httplib::Result> pictures_of(const ServerProcess& server, const Person& person) {
  std::vector<httplib::Result> all;
  for (const auto& page : person.pages)
    for (const auto& image : page["images"])
      all.push_back(server.client().Get(image["url"].get<std::string>()));
  return all;
}

TEST_F(Damage, AStimulusThatChangedIsNeverShown) {
  Fault fault(0, "frozen pictures altered, emptied, removed");
  ServerProcess server(options());
  auto client = server.client();
  const auto person = enter(client);
  std::vector<std::string> truth;
  for (const auto& picture : pictures_of(server, person)) {
    ASSERT_TRUE(picture && picture->status == 200);
    truth.push_back(picture->body);
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(data / "pictures")) files.push_back(entry.path());
  ASSERT_GE(files.size(), 6u);
  std::sort(files.begin(), files.end());
  const auto spare = folder.path / "pictures";
  fs::copy(data / "pictures", spare);
  for (const std::string kind : {"altered", "emptied", "removed"}) {
    for (const auto& file : files) {
      if (kind == "altered") {
        auto bytes = bytes_of(file);
        bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
        write(file, bytes);
      } else if (kind == "emptied") {
        fs::resize_file(file, 0);
      } else {
        fs::remove(file);
      }
      ++fault.tries;
    }
    const auto shown = pictures_of(server, person);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      ASSERT_TRUE(shown[i]);
      EXPECT_TRUE(shown[i]->status == 503 || shown[i]->body == truth[i])
          << kind << shown[i]->status;
      EXPECT_EQ(shown[i]->body.find(data.string()), std::string::npos) << shown[i]->body;
    }
    for (const auto& file : files)
      fs::copy_file(spare / file.filename(), file, fs::copy_options::overwrite_existing);
  }
  fault.did << "the true bytes or 503, never others";
}

TEST_F(Damage, ReadinessTellsOfAFullDiskAndTheLogSaysWhy) {
  Fault fault(0, "readiness and log while the disk is full");
  const BrokenSystem system(folder.path / "system", data);
  auto all = options();
  all.environment = system.environment();
  ServerProcess server(all);
  EXPECT_EQ(server.ready(), 200);
  auto client = server.client();
  const auto person = enter(client);
  system.fill_disk();
  ++fault.tries;
  const auto put =
      client.Put(person.page(0), person.answer(0, random_uuid()).dump(), "application/json");
  ASSERT_TRUE(put);
  EXPECT_EQ(put->status, 503);
  EXPECT_TRUE(eventually([&] { return server.ready() == 503; }, 30));
  EXPECT_NE(server.log().find("full"), std::string::npos) << server.log();
  system.free_disk();
  EXPECT_TRUE(eventually([&] { return server.ready() == 200; }, 30));
  fault.did << "503, the reason in the log, ready again by itself";
}

TEST_F(Damage, APublicationGoesOnAfterTheDiskWasFull) {
  Fault fault(0, "a publication that meets a full disk");
  const BrokenSystem system(folder.path / "system", data);
  auto all = options();
  all.environment = system.environment();
  ServerProcess server(all);
  auto researcher = server.researcher();
  const auto other = small_study("other");
  ASSERT_EQ(researcher.Post("/api/v1/studies", other.dump(), "application/json")->status, 201);
  ASSERT_LT(researcher.Post("/api/v1/studies/other/publish", "", "application/json")->status, 300);
  system.fill_disk();
  ++fault.tries;
  std::this_thread::sleep_for(std::chrono::seconds(1));
  system.free_disk();
  const Stopwatch watch;
  EXPECT_TRUE(eventually(
      [&] {
        const auto state = researcher.Get("/api/v1/studies/other");
        if (!state || state->status != 200) return false;
        const auto status = json::parse(state->body)["status"].get<std::string>();
        // Where it failed for good, publishing anew must work.
        if (status == "draft")
          researcher.Post("/api/v1/studies/other/publish", "", "application/json");
        return status == "open";
      },
      60));
  fault.did << "open " << static_cast<int>(watch.seconds()) << " s after there was room, without a "
            << "start";
}

TEST_F(Damage, FilesAreForTheirOwnerOnly) {
  Fault fault(0, "modes of files under an open umask");
  const auto before = ::umask(0);
  {
    ServerProcess server(options());
    ::umask(before);
    auto client = server.client();
    const auto person = enter(client);
    client.Put(person.page(0), person.answer(0, random_uuid()).dump(), "application/json");
    ASSERT_EQ(client.Get("/api/v1/image?scene=half-plane&technique=none&width=16")->status, 200);
    for (const auto& entry : fs::recursive_directory_iterator(data)) {
      ++fault.tries;
      const auto mode = entry.symlink_status().permissions();
      const auto name = entry.path().filename().string();
      const auto secret = name.starts_with("penumbra.sqlite") || name == "researcher.token";
      const auto others =
          secret ? fs::perms::group_all | fs::perms::others_all : fs::perms::others_write;
      EXPECT_EQ(mode & others, fs::perms::none) << entry.path();
    }
  }
  fault.did << "no secret is readable by others, no file writable";
}

TEST_F(Damage, ABackupUnderLoadIsWhole) {
  Fault fault(10, "backup amid answers, restored");
  ServerProcess server(options());
  Answering before(server, enter_many(server, 30), 4);
  before.finish();
  Answering meanwhile(server, enter_many(server, 400), 8);
  const auto file = folder.path / "backup";
  ++fault.tries;
  const auto made = run_program({"backup", "--data", data.string(), "--out", file.string()});
  EXPECT_EQ(made.status, 0) << made.output;
  struct stat state {};
  ASSERT_EQ(::stat(file.c_str(), &state), 0);
  EXPECT_EQ(state.st_mode & 077, 0u);
  meanwhile.stop();
  const auto checked = run_program({"verify", "--data", file.string()});
  EXPECT_EQ(checked.status, 0) << checked.output;
  EXPECT_EQ(server.terminate(), 0);
  const auto sound = run_program({"verify", "--data", data.string()});
  EXPECT_EQ(sound.status, 0) << sound.output;
  fault.did << "made in one file of mode 0600 and found whole, as the folder is";
}

}  // namespace
}  // namespace penumbra::faults
