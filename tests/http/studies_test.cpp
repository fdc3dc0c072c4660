#include <algorithm>
#include <cctype>
#include <set>
#include <thread>

#include "study/responses.h"
#include "tests/http/a_study.h"

namespace penumbra::server::http {
namespace {

/// Every value in a document, without the names of its keys.
std::string values_in(const json& value) {
  if (!value.is_structured()) return value.dump() + "\n";
  std::string text;
  for (const auto& inner : value) text += values_in(inner);
  return text;
}

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

TEST_F(AStudy, IsToldAllItsMistakesAtOnceInWords) {
  const auto fields_of = [&](const json& document) {
    const auto body = body_of(
        researcher->Post("/api/v1/studies", document.dump(), "application/json"), 400, "Error");
    std::set<std::string> fields;
    for (const auto& fault : body["error"]["errors"]) {
      fields.insert(fault["field"].get<std::string>());
      EXPECT_FALSE(fault["message"].get<std::string>().empty());
    }
    EXPECT_EQ(body["error"]["field"], body["error"]["errors"][0]["field"]);
    return fields;
  };
  const json good = study()["document"];
  json document = good;
  document["colour"] = 1;
  document["pages"][1]["camra"] = "x";
  document["quota"] = -1;
  document["picture"]["width"] = 10'000'000;
  document["labels"].erase("least");
  EXPECT_EQ(fields_of(document), (std::set<std::string>{"colour", "labels", "pages[1].camra",
                                                        "picture.width", "quota"}));
  document = good;
  document["title"].erase("nl");
  document["thanks"]["fr"] = "Merci";
  document["pages"][2]["id"] = "car";
  EXPECT_EQ(fields_of(document), (std::set<std::string>{"title.nl", "thanks.fr", "pages[2].id"}));
  document = good;
  document["pages"][0]["scene"] = "nowhere";
  document["pages"][1]["camera"] = "behind";
  document["pages"][2]["techniques"] = {"none",
                                        {{"technique", "pcf"}, {"parameters", {{"sise", 1}}}}};
  document["techniques"].push_back("unheard-of");
  EXPECT_EQ(fields_of(document),
            (std::set<std::string>{"pages[0].scene", "pages[1].camera",
                                   "pages[2].techniques[1].parameters.sise", "techniques[9]"}));
  EXPECT_EQ(study()["versions"].size(), 1u) << "nothing of them is stored";
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
