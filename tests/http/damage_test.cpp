// A study whose database was damaged while the server was down.
#include <SQLiteCpp/SQLiteCpp.h>
#include <zip.h>

#include <fstream>
#include <thread>

#include "tests/http/running_server.h"

namespace penumbra::server::http {
namespace {

class ADamagedStudy : public RunningServer {
 protected:
  void SetUp() override {
    RunningServer::SetUp();
    researcher->Post(at + "/publish", "", "application/json");
    for (int i = 0; i < 500 && status() != "open"; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    for (int i = 0; i < 2; ++i) {
      people.push_back(body_of(post(at + "/participants", json::object()), 201, "Enrolment"));
      put_answer(people.back(), i);
    }
    whole = researcher->Get(at + "/responses.csv")->body;
    stop();
  }

  std::string status() { return body_of(researcher->Get(at), 200, "Study")["status"]; }

  httplib::Result put_answer(const json& person, int number) {
    json shelves;
    for (const auto& image : person["pages"][0]["images"])
      shelves[std::to_string(image["slot"].get<int>())] = image["slot"];
    const json body = {
        {"answer_id", "00000000-0000-4000-8000-00000000000" + std::to_string(number)},
        {"shelves", shelves},
        {"difficulty", 3},
        {"active_ms", 60000},
        {"total_ms", 61000}};
    return client->Put(
        "/api/v1/participants/" + person["participant"].get<std::string>() + "/pages/0",
        body.dump(), "application/json");
  }

  void change(const std::string& sql) {
    SQLite::Database behind((folder.path / "data" / "penumbra.sqlite").string(),
                            SQLite::OPEN_READWRITE);
    behind.exec(sql);
  }

  httplib::Result readiness() {
    return httplib::Client("127.0.0.1", server->ops_port()).Get("/readyz");
  }

  std::string damaged_in_archive() {
    const auto archive = researcher->Get(at + "/export.zip");
    EXPECT_EQ(archive->status, 200) << archive->body;
    const auto file = folder.path / "export.zip";
    std::ofstream(file, std::ios::binary) << archive->body;
    int failure = 0;
    zip_t* zip = zip_open(file.c_str(), ZIP_RDONLY, &failure);
    std::string text(10000, '\0');
    zip_file_t* entry = zip_fopen(zip, "damaged.csv", 0);
    const auto count = entry == nullptr ? 0 : zip_fread(entry, text.data(), text.size());
    if (entry != nullptr) zip_fclose(entry);
    zip_discard(zip);
    text.resize(static_cast<std::size_t>(count));
    return text;
  }

  const std::string at = "/api/v1/studies/thesis-2007";
  std::vector<json> people;
  std::string whole;  ///< responses before the damage
};

TEST_F(ADamagedStudy, ExportsTheRestAndNamesWhatIsLeftOut) {
  change("UPDATE answers SET body = replace(body, '60000', '60001') WHERE id = 1");
  start();
  EXPECT_EQ(readiness()->status, 503);
  const auto csv = researcher->Get(at + "/responses.csv");
  ASSERT_EQ(csv->status, 200);
  EXPECT_EQ(csv->get_header_value("Penumbra-Damaged-Rows"), "1");
  EXPECT_LT(csv->body.size(), whole.size());
  EXPECT_EQ(csv->body.find("60001"), std::string::npos);
  const auto damaged = damaged_in_archive();
  EXPECT_NE(damaged.find("answers,1,"), std::string::npos) << damaged;
  EXPECT_NE(damaged.find("p-"), std::string::npos) << damaged;
  EXPECT_EQ(error_of(put_answer(people[1], 7), 503), "storage");
}

TEST_F(ADamagedStudy, DoesNotTellParticipantsThatTheyAreUnknown) {
  std::filesystem::resize_file(folder.path / "data" / "penumbra.sqlite", 0);
  start();
  EXPECT_EQ(readiness()->status, 503);
  EXPECT_EQ(error_of(put_answer(people[0], 8), 503), "storage");
}

TEST_F(ADamagedStudy, IsReadyWhenItIsNone) {
  start();
  EXPECT_EQ(readiness()->status, 200);
  EXPECT_EQ(researcher->Get(at + "/responses.csv")->body, whole);
  EXPECT_EQ(damaged_in_archive(), "");
}

}  // namespace
}  // namespace penumbra::server::http
