#include <algorithm>

#include "tests/http/a_study.h"

namespace penumbra::server::http {
namespace {

/// A study like the one that ships, with two small pages.
class Versions : public AStudy {
 protected:
  json document(const json& more = json::object()) {
    json changed = study()["document"];
    changed["id"] = "small";
    changed["techniques"] = {"none", "shadow-map", "reference"};
    changed["pages"] = {{{"scene", "boxes"}}, {{"scene", "car"}}};
    changed.update(more);
    return changed;
  }

  json store(const json& document, int state = 201) {
    return body_of(researcher->Post("/api/v1/studies", document.dump(), "application/json"), state,
                   "Study");
  }

  json open(const json& document) {
    store(document);
    EXPECT_EQ(researcher->Post(small + "/publish", "", "application/json")->status, 202);
    return wait_until(small, "open");
  }

  json change(const std::string& action, int state = 200) {
    return body_of(researcher->Post(small + action, "", "application/json"), state, "Study");
  }

  json arrive(const json& body = json::object()) {
    return body_of(post(small + "/participants", body), 201, "Enrolment");
  }

  json state_of(const json& person) {
    return body_of(client->Get("/api/v1/participants/" + person["participant"].get<std::string>()),
                   200, "Enrolment");
  }

  httplib::Result answer_page(const json& person, std::size_t page, int number) {
    return put(page_of(person, page), answer(person["pages"][page], number));
  }

  const std::string small = "/api/v1/studies/small";
};

TEST_F(Versions, ADraftStandsBesideTheOpenVersionAndHidesItFromNoOne) {
  const auto first = open(document());
  const auto person = arrive();
  const auto second = store(document({{"quota", 7}}));
  EXPECT_EQ(second["version"], 2);
  EXPECT_EQ(second["status"], "draft");
  const auto shown = body_of(researcher->Get(small), 200, "Study");
  EXPECT_EQ(shown["version"], 1);
  EXPECT_EQ(shown["status"], "open");
  ASSERT_EQ(shown["versions"].size(), 2u);
  EXPECT_EQ(shown["versions"][0]["status"], "draft");
  EXPECT_EQ(shown["versions"][1]["participants"]["entered"], 1);
  const auto list = body_of(researcher->Get("/api/v1/studies"), 200, "StudyList");
  for (const auto& entry : list["studies"])
    if (entry["id"] == "small") {
      EXPECT_EQ(entry["status"], "open");
    }
  EXPECT_EQ(body_of(researcher->Get(small + "?version=2"), 200, "Study")["document"]["quota"], 7);
  EXPECT_EQ(body_of(client->Get("/s/small/welcome"), 200, "Welcome")["status"], "open");
  body_of(answer_page(person, 0, 1), 200, "AnswerReply");
  const auto published = change("/publish", 202);
  EXPECT_EQ(published["version"], 2);
  const auto now = wait_until(small, "open");
  EXPECT_EQ(now["version"], 2);
  EXPECT_NE(now["hash"], first["hash"]);
  const auto old = researcher->Get(small + "/responses.csv?version=1");
  EXPECT_NE(old->body.find(first["hash"].get<std::string>()), std::string::npos);
}

TEST_F(Versions, AnIdenticalDocumentIsNoNewVersion) {
  open(document());
  json same = document();
  same["$schema"] = "../schema/study.schema.json";  // for editors, no part of the study
  const auto again = store(same, 200);
  EXPECT_EQ(again["version"], 1);
  EXPECT_EQ(again["versions"].size(), 1u);
  store(document({{"quota", 7}}));
  EXPECT_EQ(store(document(), 200)["version"], 1);
  EXPECT_EQ(body_of(researcher->Get(small), 200, "Study")["versions"].size(), 2u);
}

TEST_F(Versions, PeopleAmidAClosedVersionAreToldUntilWhenTheyCanFinish) {
  open(document());
  const auto person = arrive();
  EXPECT_TRUE(person["closes_at"].is_null());
  body_of(answer_page(person, 0, 1), 200, "AnswerReply");
  const auto closed = change("/close");
  EXPECT_EQ(closed["status"], "closed");
  EXPECT_EQ(error_of(post(small + "/participants", json::object()), 409), "conflict");
  const auto state = state_of(person);
  EXPECT_EQ(state["status"], "started");
  EXPECT_GT(state["closes_at"], closed["versions"][0]["closed_at"]);
  body_of(answer_page(person, 1, 2), 200, "AnswerReply");
  EXPECT_EQ(body_of(complete(person), 200, "Completion")["status"], "completed");
}

TEST_F(Versions, AfterTheGraceTimeTheStudyIsOverAndWhatWasAnsweredStays) {
  open(document({{"grace_minutes", 0}}));
  const auto amid = arrive();
  const auto done = arrive();
  body_of(answer_page(amid, 0, 1), 200, "AnswerReply");
  for (const int page : {0, 1}) body_of(answer_page(done, page, 10 + page), 200, "AnswerReply");
  change("/close");
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(error_of(answer_page(amid, 1, 2), 409), "conflict");
  const auto state = state_of(amid);
  EXPECT_EQ(state["status"], "over");
  EXPECT_EQ(state["answered"], 1);
  // Who had answered every page gets the code at any time.
  EXPECT_EQ(state_of(done)["status"], "started");
  EXPECT_EQ(body_of(complete(done), 200, "Completion")["completion_code"], "SHADOWS-2007");
  const auto rows = researcher->Get(small + "/responses.csv");
  EXPECT_EQ(std::count(rows->body.begin(), rows->body.end(), '\n'), 1 + 3 + 6);
}

TEST_F(Versions, AClosedVersionOpensAgain) {
  open(document());
  const auto person = arrive();
  EXPECT_EQ(error_of(researcher->Post(small + "/reopen", "", "application/json"), 409), "conflict");
  change("/close");
  EXPECT_EQ(change("/reopen")["status"], "open");
  EXPECT_TRUE(state_of(person)["closes_at"].is_null());
  arrive();
  store(document({{"quota", 7}}));
  change("/publish", 202);
  wait_until(small, "open");
  EXPECT_EQ(error_of(researcher->Post(small + "/reopen?version=1", "", "application/json"), 409),
            "conflict");
}

TEST_F(Versions, DraftsAreDeletedAndOpenedVersionsAreNot) {
  const auto draft = store(document());
  EXPECT_EQ(draft["status"], "draft");
  EXPECT_EQ(researcher->Delete(small + "/draft")->status, 204);
  EXPECT_EQ(error_of(researcher->Get(small), 404), "not_found");
  open(document());
  EXPECT_EQ(error_of(researcher->Delete(small + "/draft"), 409), "conflict");
  store(document({{"quota", 7}}));
  EXPECT_EQ(error_of(client->Delete(small + "/draft"), 401), "unauthorized");
  EXPECT_EQ(researcher->Delete(small + "/draft")->status, 204);
  EXPECT_EQ(body_of(researcher->Get(small), 200, "Study")["versions"].size(), 1u);
  const auto file = researcher->Get(small + "/study.json");
  EXPECT_EQ(json::parse(file->body), document());
}

TEST_F(Versions, ADraftIsLookedAtWithItsPicturesAndNeverCounted) {
  store(document());
  EXPECT_EQ(error_of(client->Get("/s/small/welcome?version=1"), 404), "not_found");
  EXPECT_EQ(body_of(researcher->Get("/s/small/welcome?version=1"), 200, "Welcome")["status"],
            "draft");
  EXPECT_EQ(client->Get("/s/small")->status, 404);
  EXPECT_EQ(researcher->Get("/s/small?preview=1")->status, 200);
  const json preview = {{"preview", true}, {"version", 1}};
  EXPECT_EQ(error_of(post(small + "/participants", preview), 401), "unauthorized");
  EXPECT_EQ(error_of(post(small + "/participants", {{"version", 1}}), 400), "bad_value");
  const auto person =
      body_of(researcher->Post(small + "/participants", preview.dump(), "application/json"), 201,
              "Enrolment");
  EXPECT_TRUE(person["test"].get<bool>());
  const auto picture = client->Get(person["pages"][0]["images"][0]["url"].get<std::string>());
  ASSERT_EQ(picture->status, 200);
  EXPECT_EQ(picture->body.substr(1, 3), "PNG");
  body_of(answer_page(person, 0, 1), 200, "AnswerReply");
  body_of(answer_page(person, 1, 2), 200, "AnswerReply");
  body_of(complete(person), 200, "Completion");
  store(document({{"quota", 7}}));  // replaces the draft, and what was tried on it
  EXPECT_EQ(client->Get("/api/v1/participants/" + person["participant"].get<std::string>())->status,
            404);
  change("/publish", 202);
  const auto counts = wait_until(small, "open")["participants"];
  EXPECT_EQ(counts["entered"], 0);
}

TEST_F(Versions, ANameInTheLinkEntersOnceUnlessTheStudyAllowsMore) {
  open(document());
  const json link = {{"parameters", {{"PROLIFIC_PID", "abc"}, {"STUDY_ID", "same"}}}};
  const auto person = arrive(link);
  EXPECT_EQ(error_of(post(small + "/participants", link), 409), "conflict");
  EXPECT_EQ(field_of(post(small + "/participants", link)), "parameters");
  arrive({{"parameters", {{"PROLIFIC_PID", "def"}, {"STUDY_ID", "same"}}}});
  arrive();  // without a name
  arrive();
  open(document({{"several_entries", true}}));
  const auto again = arrive(link);
  body_of(answer_page(again, 0, 1), 200, "AnswerReply");
  const auto list = body_of(researcher->Get(small + "/participants"), 200, "ParticipantList");
  ASSERT_EQ(list["participants"].size(), 1u);
  ASSERT_EQ(list["participants"][0]["flags"].size(), 1u);
  const auto& flag = list["participants"][0]["flags"][0];
  EXPECT_EQ(flag["flag"], "several_entries");
  EXPECT_EQ(flag["value"], 2);
}

TEST_F(Versions, EveryWayInWhichTakingPartEndsHasItsCode) {
  open(document({{"quota", 1},
                 {"completion",
                  {{"code", "DONE"},
                   {"url", ""},
                   {"screened_out", {{"code", "OUT"}, {"url", "https://example.org/out"}}},
                   {"over_quota", {{"code", "FULL"}}}}},
                 {"brightness", {{"minimum_patches", 5}, {"consequence", "screen_out"}}}}));
  const auto screen = [&](const json& person, int patches) {
    return body_of(
        client->Put("/api/v1/participants/" + person["participant"].get<std::string>() + "/screen",
                    json{{"patches_seen", patches}}.dump(), "application/json"),
        200, "Enrolment");
  };
  const auto dim = arrive();
  EXPECT_EQ(screen(dim, 5)["status"], "started");
  const auto out = screen(dim, 4);
  EXPECT_EQ(out["status"], "screened_out");
  EXPECT_EQ(out["completion_code"], "OUT");
  EXPECT_EQ(out["completion_url"], "https://example.org/out");
  EXPECT_EQ(error_of(answer_page(dim, 0, 1), 409), "conflict");
  EXPECT_EQ(body_of(complete(dim), 200, "Completion")["completion_code"], "OUT");
  EXPECT_FALSE(body_of(client->Get("/s/small/welcome"), 200, "Welcome")["full"].get<bool>());
  const auto person = arrive();
  for (const int page : {0, 1}) body_of(answer_page(person, page, 10 + page), 200, "AnswerReply");
  EXPECT_EQ(body_of(complete(person), 200, "Completion")["completion_code"], "DONE");
  const auto welcome = body_of(client->Get("/s/small/welcome"), 200, "Welcome");
  EXPECT_TRUE(welcome["full"].get<bool>());
  EXPECT_EQ(welcome["completion_code"], "FULL");
  EXPECT_EQ(error_of(post(small + "/participants", json::object()), 409), "conflict");
}

TEST_F(Versions, AttentionAndGoldItemsHaveTheirConsequence) {
  json pages = {
      {{"scene", "boxes"}, {"expected", {{"better", "reference"}, {"worse", "none"}}}},
      {{"id", "attention"},
       {"scene", "car"},
       {"expected", "all_same"},
       {"question", {{"en", "Put all on one shelf."}, {"nl", "Zet alle op een plank."}}}}};
  const json rule = {{"allowed_failures", 0}, {"consequence", "screen_out"}};
  open(document({{"pages", pages}, {"expectations", rule}}));
  const auto person = arrive();
  std::size_t attention = 0;
  for (const auto& page : person["pages"])
    if (page["question"] == "Put all on one shelf.") attention = page["page"];
  auto body = answer(person["pages"][attention], 1);
  for (auto& shelf : body["shelves"]) shelf = 0;
  body_of(put(page_of(person, attention), body), 200, "AnswerReply");
  EXPECT_EQ(state_of(person)["status"], "started");
  body = answer(person["pages"][attention], 2);
  body_of(put(page_of(person, attention), body), 200, "AnswerReply");
  EXPECT_EQ(state_of(person)["status"], "screened_out");
  EXPECT_EQ(error_of(put(page_of(person, attention), answer(person["pages"][attention], 3)), 409),
            "conflict");
  body_of(put(page_of(person, attention), body), 200, "AnswerReply");  // its reply was lost
  const auto list = body_of(researcher->Get(small + "/participants"), 200, "ParticipantList");
  EXPECT_EQ(list["participants"][0]["outcome"], "screened_out");
  EXPECT_EQ(list["participants"][0]["flags"][0]["flag"], "attention");
  EXPECT_EQ(list["participants"][0]["timeline"].size(), 2u);
  // An attention item ranks nothing.
  const auto rows = researcher->Get(small + "/responses.csv");
  EXPECT_EQ(std::count(rows->body.begin(), rows->body.end(), '\n'), 1);
}

}  // namespace
}  // namespace penumbra::server::http
