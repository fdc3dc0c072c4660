#include <zip.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include "study/csv.h"
#include "study/responses.h"
#include "tests/http/running_server.h"

namespace penumbra::server::http {
namespace {

/// Every value in a document, without the names of its keys.
std::string values_in(const json& value) {
  if (!value.is_structured()) return value.dump() + "\n";
  std::string text;
  for (const auto& inner : value) text += values_in(inner);
  return text;
}

/// The study that ships, opened, and people in it.
class AStudy : public RunningServer {
 protected:
  const std::string id = "thesis-2007";
  const std::string at = "/api/v1/studies/thesis-2007";

  json study() { return body_of(researcher->Get(at), 200, "Study"); }

  json wait_until(const std::string& study_path, const std::string& status) {
    json body;
    for (int i = 0; i < 200; ++i) {
      body = body_of(researcher->Get(study_path), 200, "Study");
      if (body["status"] == status) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_EQ(body["status"], status);
    return body;
  }

  json publish() {
    const auto result = researcher->Post(at + "/publish", "", "application/json");
    EXPECT_TRUE(result->status == 202 || result->status == 200) << result->body;
    return wait_until(at, "open");
  }

  json enter(const json& body = json::object()) {
    return body_of(post(at + "/participants", body), 201, "Enrolment");
  }

  static std::string uuid(int number) {
    const auto digits = std::to_string(number);
    return "00000000-0000-4000-8000-" + std::string(12 - digits.size(), '0') + digits;
  }

  /// An answer that puts the pictures in the order of their slots.
  static json answer(const json& page, int number, int difficulty = 3) {
    json shelves;
    for (const auto& image : page["images"])
      shelves[std::to_string(image["slot"].get<int>())] = image["slot"];
    return {{"answer_id", uuid(number)},
            {"shelves", shelves},
            {"difficulty", difficulty},
            {"active_ms", 60000},
            {"total_ms", 61000}};
  }

  static std::string page_of(const json& person, std::size_t page) {
    return "/api/v1/participants/" + person["participant"].get<std::string>() + "/pages/" +
           std::to_string(page);
  }

  httplib::Result put(const std::string& path, const json& body) {
    return client->Put(path, body.dump(), "application/json");
  }

  void answer_all(const json& person, int first_number) {
    for (std::size_t page = 0; page < person["pages"].size(); ++page)
      body_of(put(page_of(person, page),
                  answer(person["pages"][page], first_number + static_cast<int>(page))),
              200, "AnswerReply");
  }

  httplib::Result complete(const json& person) {
    return client->Post(
        "/api/v1/participants/" + person["participant"].get<std::string>() + "/complete", "{}",
        "application/json");
  }
};

TEST_F(AStudy, ShipsAsDraftThatNobodyElseSees) {
  const auto list = body_of(researcher->Get("/api/v1/studies"), 200, "StudyList")["studies"];
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0]["id"], id);
  EXPECT_EQ(list[0]["status"], "draft");
  EXPECT_EQ(error_of(client->Get("/s/thesis-2007/welcome"), 404), "not_found");
  EXPECT_EQ(error_of(post(at + "/participants", {}), 404), "not_found");
  EXPECT_EQ(error_of(researcher->Get(at + "/responses.csv"), 409), "conflict");
}

TEST_F(AStudy, OpensOnceEveryPictureIsFrozen) {
  const auto open = publish();
  EXPECT_EQ(open["progress"]["pictures"], open["progress"]["pictures_total"]);
  const auto& document = open["document"];
  EXPECT_EQ(open["progress"]["pictures_total"],
            document["pages"].size() * document["techniques"].size());
  EXPECT_EQ(open["hash"].get<std::string>().size(), 64u);
  const auto welcome = body_of(client->Get("/s/thesis-2007/welcome"), 200, "Welcome");
  EXPECT_EQ(welcome["status"], "open");
  const int submitted = renders->submitted;
  body_of(researcher->Post(at + "/publish", "", "application/json"), 200, "Study");
  EXPECT_EQ(renders->submitted, submitted);
}

TEST_F(AStudy, ThatCannotBeRenderedStaysDraftAndSaysWhy) {
  json document = study()["document"];
  document["id"] = "unlucky";
  document["pages"][0]["scene"] = "broken";
  body_of(researcher->Post("/api/v1/studies", document.dump(), "application/json"), 201, "Study");
  body_of(researcher->Post("/api/v1/studies/unlucky/publish", "", "application/json"), 202,
          "Study");
  json body;
  for (int i = 0; i < 200 && (body.is_null() || body["progress"]["error"].is_null()); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    body = body_of(researcher->Get("/api/v1/studies/unlucky"), 200, "Study");
  }
  EXPECT_EQ(body["status"], "draft");
  EXPECT_EQ(body["progress"]["error"]["code"], "deadline");
  EXPECT_TRUE(body["hash"].is_null());
}

TEST_F(AStudy, WithMistakesIsRefusedNamingTheField) {
  json document = study()["document"];
  document["pages"][0].erase("scene");
  const auto result = researcher->Post("/api/v1/studies", document.dump(), "application/json");
  EXPECT_EQ(error_of(result, 400), "bad_value");
  EXPECT_NE(field_of(result).find("pages"), std::string::npos);
}

TEST_F(AStudy, TellsParticipantsNothingOfTechniques) {
  publish();
  const auto person = enter();
  const auto welcome = body_of(client->Get("/s/thesis-2007/welcome"), 200, "Welcome");
  const auto text = values_in(person) + values_in(welcome);
  const auto list = body_of(researcher->Get("/api/v1/techniques"), 200, "TechniqueList");
  for (const auto& technique : list["techniques"]) {
    const auto name = technique["id"].get<std::string>();
    if (name.size() <= 4) continue;  // "none", "esm": in any text
    EXPECT_EQ(text.find(name), std::string::npos) << name;
  }
  EXPECT_EQ(text.find(study()["document"]["completion"]["code"].get<std::string>()),
            std::string::npos);
}

TEST_F(AStudy, ServesPicturesThatOnlyTheirPixelsTellApart) {
  publish();
  const auto person = enter();
  const auto other = enter();
  std::set<std::string> headers;
  std::set<std::string> bodies;
  std::set<std::string> urls;
  for (const auto* who : {&person, &other})
    for (const auto& image : (*who)["pages"][0]["images"]) {
      urls.insert(image["url"].get<std::string>());
      const auto picture = client->Get(image["url"].get<std::string>());
      ASSERT_TRUE(picture);
      ASSERT_EQ(picture->status, 200);
      std::string names;
      for (const auto& [name, value] : picture->headers)
        if (name != "Content-Length" && name != "Date") names += name + "=" + value + "\n";
      headers.insert(names);
      bodies.insert(picture->body);
      EXPECT_FALSE(picture->has_header("ETag"));
      EXPECT_FALSE(picture->has_header("Last-Modified"));
      EXPECT_EQ(chunk_types(picture->body), (std::vector<std::string>{"IHDR", "IDAT", "IEND"}));
    }
  EXPECT_EQ(headers.size(), 1u);
  EXPECT_GT(bodies.size(), 1u);
  EXPECT_EQ(urls.size(), person["pages"][0]["images"].size() * 2);
  EXPECT_EQ(error_of(client->Get(page_of(person, 0) + "/pictures/99"), 404), "not_found");
  EXPECT_EQ(error_of(client->Get(page_of(person, 99) + "/pictures/0"), 404), "not_found");
}

TEST_F(AStudy, KeepsAnAnswerOnceHoweverOftenItIsSent) {
  publish();
  const auto person = enter();
  const auto body = answer(person["pages"][0], 1);
  const auto first = put(page_of(person, 0), body);
  body_of(first, 200, "AnswerReply");
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(put(page_of(person, 0), body)->body, first->body);
  EXPECT_EQ(error_of(put(page_of(person, 0), answer(person["pages"][0], 1, 4)), 409), "conflict");
  const auto replaced =
      body_of(put(page_of(person, 0), answer(person["pages"][0], 2, 4)), 200, "AnswerReply");
  EXPECT_EQ(replaced["replaced"], uuid(1));
  EXPECT_EQ(replaced["pages_answered"], 1);
  const auto state =
      body_of(client->Get("/api/v1/participants/" + person["participant"].get<std::string>()), 200,
              "Enrolment");
  EXPECT_EQ(state["pages"][0]["answer"]["difficulty"], 4);
  EXPECT_TRUE(state["pages"][1]["answer"].is_null());
}

TEST_F(AStudy, RefusesAnswersThatAreNone) {
  publish();
  const auto person = enter();
  json body = answer(person["pages"][1], 1);
  body["shelves"].erase("0");
  EXPECT_EQ(error_of(put(page_of(person, 1), body), 400), "bad_value");
  EXPECT_EQ(error_of(put(page_of(person, 99), answer(person["pages"][0], 2)), 404), "not_found");
  EXPECT_EQ(
      error_of(put("/api/v1/participants/nobody/pages/0", answer(person["pages"][0], 3)), 404),
      "not_found");
  EXPECT_EQ(error_of(client->Put(page_of(person, 0), "not json", "application/json"), 400),
            "bad_value");
}

TEST_F(AStudy, GivesTheCodeOnlyAfterTheLastPage) {
  publish();
  const auto person = enter();
  EXPECT_TRUE(person["completion_code"].is_null());
  EXPECT_EQ(error_of(complete(person), 409), "conflict");
  answer_all(person, 100);
  const auto done = body_of(complete(person), 200, "Completion");
  EXPECT_EQ(done["completion_code"], study()["document"]["completion"]["code"]);
  EXPECT_EQ(body_of(complete(person), 200, "Completion"), done);
  EXPECT_EQ(study()["participants"]["completed"], 1);
  EXPECT_EQ(error_of(put(page_of(person, 0), answer(person["pages"][0], 999)), 409), "conflict");
}

TEST_F(AStudy, EnrolsALostReplyOnce) {
  publish();
  const json body = {{"enrolment_id", uuid(7)}, {"language", "nl"}};
  const auto first = enter(body);
  EXPECT_EQ(enter(body), first);
  EXPECT_EQ(first["language"], "nl");
  EXPECT_NE(enter()["participant"], first["participant"]);
  EXPECT_EQ(error_of(post(at + "/participants", {{"enrolment_id", "1"}}), 400), "bad_value");
  EXPECT_EQ(error_of(post(at + "/participants", {{"unknown", 1}}), 400), "bad_value");
  EXPECT_EQ(error_of(post(at + "/participants", {{"consent_version", "0"}}), 409), "conflict");
}

TEST_F(AStudy, LosesNothingOverARestart) {
  publish();
  const auto person = enter();
  answer_all(person, 1);
  restart();
  const auto state =
      body_of(client->Get("/api/v1/participants/" + person["participant"].get<std::string>()), 200,
              "Enrolment");
  for (const auto& page : state["pages"]) EXPECT_FALSE(page["answer"].is_null());
  for (std::size_t page = 0; page < state["pages"].size(); ++page)
    EXPECT_EQ(state["pages"][page]["images"], person["pages"][page]["images"]);
  EXPECT_EQ(client->Get(person["pages"][0]["images"][0]["url"].get<std::string>())->status, 200);
  body_of(complete(person), 200, "Completion");
}

TEST_F(AStudy, GoesOnPublishingAfterARestart) {
  json document = study()["document"];
  document["id"] = "slowly";
  document["pages"][0]["scene"] = "slow";
  body_of(researcher->Post("/api/v1/studies", document.dump(), "application/json"), 201, "Study");
  body_of(researcher->Post("/api/v1/studies/slowly/publish", "", "application/json"), 202, "Study");
  EXPECT_EQ(error_of(researcher->Post("/api/v1/studies", document.dump(), "application/json"), 409),
            "conflict");
  restart();
  EXPECT_EQ(body_of(researcher->Get("/api/v1/studies/slowly"), 200, "Study")["status"],
            "publishing");
}

TEST_F(AStudy, ForgetsWhoWithdraws) {
  publish();
  const auto person = enter();
  answer_all(person, 1);
  const auto withdrawal = "/api/v1/withdrawals/" + person["withdrawal_code"].get<std::string>();
  auto typed = withdrawal;
  typed.erase(std::remove(typed.begin() + 20, typed.end(), '-'), typed.end());
  std::transform(typed.begin() + 20, typed.end(), typed.begin() + 20,
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  ASSERT_NE(typed, withdrawal);
  EXPECT_EQ(client->Delete(typed)->status, 204);
  EXPECT_EQ(error_of(client->Delete(withdrawal), 404), "not_found");
  EXPECT_EQ(client->Get("/api/v1/participants/" + person["participant"].get<std::string>())->status,
            404);
  const auto counts = study()["participants"];
  EXPECT_EQ(counts["entered"], 0);
  EXPECT_EQ(counts["withdrawn"], 1);
  const auto csv = researcher->Get(at + "/responses.csv");
  EXPECT_EQ(std::count(csv->body.begin(), csv->body.end(), '\n'), 1);
}

TEST_F(AStudy, PreviewsAreMarkedAndNeverCounted) {
  publish();
  EXPECT_EQ(error_of(post(at + "/participants", {{"preview", true}}), 401), "unauthorized");
  const auto result =
      researcher->Post(at + "/participants", R"({"preview":true})", "application/json");
  const auto person = body_of(result, 201, "Enrolment");
  EXPECT_TRUE(person["test"].get<bool>());
  answer_all(person, 1);
  EXPECT_EQ(study()["participants"]["entered"], 0);
  EXPECT_EQ(study()["participants"]["tests"], 1);
  const auto csv = researcher->Get(at + "/responses.csv");
  EXPECT_EQ(std::count(csv->body.begin(), csv->body.end(), '\n'), 1);
}

TEST_F(AStudy, ExportsARowPerRankedPicture) {
  publish();
  for (int i = 0; i < 4; ++i) {
    const auto person = enter();
    answer_all(person, 100 * (i + 1));
    body_of(complete(person), 200, "Completion");
  }
  const auto csv = researcher->Get(at + "/responses.csv");
  ASSERT_TRUE(csv);
  EXPECT_EQ(csv->status, 200);
  std::size_t pictures = 0;
  const auto another = enter();
  for (const auto& page : another["pages"])
    if (page["kind"] == "ranking") pictures += page["images"].size();
  EXPECT_EQ(std::count(csv->body.begin(), csv->body.end(), '\n'),
            static_cast<std::ptrdiff_t>(4 * pictures + 1));
  EXPECT_NE(csv->body.find(study()["hash"].get<std::string>()), std::string::npos);
  const auto results = body_of(researcher->Get(at + "/results.json"), 200, "Results");
  EXPECT_EQ(results["participants"], 4);
  const auto counted = study();
  for (const auto& page : counted["scenes"]) EXPECT_EQ(page["answers"], 4);
}

/// Files of an archive by name.
std::map<std::string, std::string> unpacked(const std::filesystem::path& file) {
  std::map<std::string, std::string> files;
  int failure = 0;
  zip_t* zip = zip_open(file.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &failure);
  if (zip == nullptr) return files;
  for (zip_int64_t i = 0; i < zip_get_num_entries(zip, 0); ++i) {
    zip_stat_t stat;
    zip_stat_index(zip, static_cast<zip_uint64_t>(i), 0, &stat);
    std::string bytes(stat.size, '\0');
    zip_file_t* entry = zip_fopen_index(zip, static_cast<zip_uint64_t>(i), 0);
    EXPECT_EQ(zip_fread(entry, bytes.data(), bytes.size()), static_cast<zip_int64_t>(stat.size));
    EXPECT_EQ(zip_fclose(entry), 0) << stat.name;  // its checksum is right
    files[stat.name] = std::move(bytes);
  }
  zip_discard(zip);
  return files;
}

TEST_F(AStudy, ExportsEverythingInOneArchive) {
  publish();
  const auto person = enter();
  answer_all(person, 1);
  body_of(put(page_of(person, 0), answer(person["pages"][0], 500, 5)), 200, "AnswerReply");
  body_of(complete(person), 200, "Completion");
  answer_all(enter(), 100);
  const auto archive = researcher->Get(at + "/export.zip");
  ASSERT_TRUE(archive);
  ASSERT_EQ(archive->status, 200);
  const auto file = folder.path / "export.zip";
  std::ofstream(file, std::ios::binary) << archive->body;
  const auto files = unpacked(file);
  // Every file is in the codebook, and every file of the codebook is there.
  std::set<std::string> explained;
  for (const auto& record : study::parse_csv(files.at("codebook.csv")))
    explained.insert(record.cells[0]);
  explained.erase("file");
  std::set<std::string> names;
  for (const auto& [name, bytes] : files) {
    names.insert(name.starts_with("figures/") ? "figures/*.svg" : name);
    EXPECT_FALSE(bytes.empty()) << name;
  }
  EXPECT_EQ(names, explained);
  EXPECT_EQ(files.at("responses.csv"), researcher->Get(at + "/responses.csv")->body);
  const auto rows = study::parse_responses(files.at("responses.csv"));
  ASSERT_EQ(rows.size(), 2u * 6u * 9u);
  EXPECT_FALSE(rows.front().started_at.empty());
  // A pair each of nine pictures on six pages of two people.
  EXPECT_EQ(study::parse_csv(files.at("pairs.csv")).size(), 1u + 2u * 6u * 36u);
  EXPECT_EQ(study::parse_csv(files.at("responses_wide.csv")).size(), 3u);
  EXPECT_EQ(study::parse_csv(files.at("participants.csv")).size(), 3u);
  const auto people = json::parse(files.at("responses.json"))["participants"];
  ASSERT_EQ(people.size(), 2u);
  EXPECT_FALSE(people[0]["completed_at"].is_null());
  EXPECT_TRUE(people[1]["completed_at"].is_null());
  const auto& first = people[0]["pages"][0];
  EXPECT_EQ(first["answer"]["body"]["difficulty"], 5);
  ASSERT_EQ(first["earlier_answers"].size(), 1u);
  EXPECT_EQ(first["earlier_answers"][0]["body"]["difficulty"], 3);
  EXPECT_EQ(first["pictures_by_slot"].size(), 9u);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path / "data" / "tmp"));
}

TEST_F(AStudy, ShowsItsReportAndFigures) {
  publish();
  EXPECT_EQ(error_of(client->Get(at + "/report.html"), 401), "unauthorized");
  for (int i = 1; i < 4; ++i) answer_all(enter(), 100 * i);
  const auto report = researcher->Get(at + "/report.html");
  ASSERT_TRUE(report);
  EXPECT_EQ(report->status, 200);
  EXPECT_EQ(report->get_header_value("Content-Type"), "text/html; charset=utf-8");
  EXPECT_NE(report->get_header_value("Content-Security-Policy").find("default-src 'none'; style"),
            std::string::npos);
  EXPECT_NE(report->body.find("Which shadows look real?"), std::string::npos);
  const auto list = body_of(researcher->Get(at + "/figures"), 200, "FigureList")["figures"];
  ASSERT_FALSE(list.empty());
  for (const auto& figure : {list.front(), list.back()}) {
    const auto svg = researcher->Get(figure["url"].get<std::string>() + "?width_mm=120");
    ASSERT_TRUE(svg);
    EXPECT_EQ(svg->status, 200);
    EXPECT_EQ(svg->get_header_value("Content-Type"), "image/svg+xml");
    EXPECT_NE(svg->body.find("width=\"120mm\""), std::string::npos);
  }
  EXPECT_EQ(error_of(researcher->Get(at + "/figures/none.svg"), 404), "not_found");
  EXPECT_EQ(error_of(researcher->Get(at + "/figures/worths.svg?set=some"), 400), "bad_value");
  EXPECT_EQ(error_of(researcher->Get(at + "/figures/worths.svg?width_mm=0"), 400), "bad_value");
}

TEST_F(AStudy, ExcludesPeopleOnRecordAndTakesThemBack) {
  publish();
  answer_all(enter(), 1);
  const auto list = body_of(researcher->Get(at + "/participants"), 200, "ParticipantList");
  ASSERT_EQ(list["participants"].size(), 1u);
  const auto pseudonym = list["participants"][0]["participant"].get<std::string>();
  const auto decide = [&](bool excluded) {
    const json body = {{"excluded", excluded}, {"reason", "scale turned round"}};
    return body_of(researcher->Put(at + "/participants/" + pseudonym + "/exclusion", body.dump(),
                                   "application/json"),
                   200, "Participant");
  };
  EXPECT_TRUE(decide(true)["excluded"].get<bool>());
  const auto all_included = [&](bool included) {
    const auto rows = study::parse_responses(researcher->Get(at + "/responses.csv")->body);
    return !rows.empty() && std::all_of(rows.begin(), rows.end(),
                                        [&](const auto& row) { return row.included == included; });
  };
  EXPECT_TRUE(all_included(false));
  const auto back = decide(false);
  EXPECT_FALSE(back["excluded"].get<bool>());
  EXPECT_EQ(back["history"].size(), 2u);
  EXPECT_TRUE(all_included(true));
}

TEST_F(AStudy, ClosesAndBecomesANewVersionWhenChanged) {
  const auto first = publish();
  const auto person = enter();
  json document = first["document"];
  document["title"]["en"] = "Another title";
  EXPECT_EQ(body_of(researcher->Post("/api/v1/studies", document.dump(), "application/json"), 201,
                    "Study")["version"],
            2);
  body_of(put(page_of(person, 0), answer(person["pages"][0], 1)), 200, "AnswerReply");
  const auto second = publish();
  EXPECT_NE(second["hash"], first["hash"]);
  // Who was amid the first version may finish it as long as its successor is open.
  body_of(put(page_of(person, 0), answer(person["pages"][0], 2)), 200, "AnswerReply");
  const auto old = researcher->Get(at + "/responses.csv?version=1");
  EXPECT_NE(old->body.find(first["hash"].get<std::string>()), std::string::npos);
  body_of(researcher->Post(at + "/close", "", "application/json"), 200, "Study");
  EXPECT_EQ(error_of(put(page_of(person, 0), answer(person["pages"][0], 3)), 409), "conflict");
  EXPECT_EQ(error_of(post(at + "/participants", {}), 409), "conflict");
  EXPECT_EQ(body_of(client->Get("/s/thesis-2007/welcome"), 200, "Welcome")["status"], "closed");
}

TEST_F(AStudy, KeepsTextsVerbatim) {
  publish();
  const auto person = enter();
  const std::string text = "'); DROP TABLE answers; -- <script>alert(1)</script> =1+1";
  answer_all(person, 1);
  const auto done =
      client->Post("/api/v1/participants/" + person["participant"].get<std::string>() + "/complete",
                   json{{"comment", text}}.dump(), "application/json");
  body_of(done, 200, "Completion");
  EXPECT_EQ(study()["participants"]["completed"], 1);
}

}  // namespace
}  // namespace penumbra::server::http
