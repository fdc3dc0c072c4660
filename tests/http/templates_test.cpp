// Study files that the laboratory offers, and the ways of giving ranks that people get.
#include <algorithm>
#include <map>

#include "tests/http/a_study.h"

namespace penumbra::server::http {
namespace {

class Templates : public AStudy {
 protected:
  json list() {
    return body_of(researcher->Get("/api/v1/templates"), 200, "TemplateList")["templates"];
  }
};

TEST_F(Templates, AreListedAndEachIsAStudyThatCanBePublished) {
  const auto all = list();
  ASSERT_GE(all.size(), 1u);
  for (const auto& one : all) {
    EXPECT_FALSE(one["about"].get<std::string>().empty()) << one;
    const auto file = researcher->Get(one["links"]["self"].get<std::string>());
    ASSERT_EQ(file->status, 200) << one;
    const auto stored =
        body_of(researcher->Post("/api/v1/studies", file->body, "application/json"), 201, "Study");
    EXPECT_EQ(stored["document"], json::parse(file->body));
    const auto path = "/api/v1/studies/" + one["id"].get<std::string>();
    EXPECT_EQ(researcher->Post(path + "/publish", "", "application/json")->status, 202);
    wait_until(path, "open");
  }
  EXPECT_EQ(error_of(client->Get("/api/v1/templates"), 401), "unauthorized");
  EXPECT_EQ(error_of(researcher->Get("/api/v1/templates/unheard-of"), 404), "not_found");
}

TEST_F(Templates, PeopleAnswerInTheWayThatTheyWereAssignedTo) {
  const auto file = researcher->Get("/api/v1/templates/digits-or-shelves");
  researcher->Post("/api/v1/studies", file->body, "application/json");
  ASSERT_EQ(RunningServer::publish("digits-or-shelves"), "open");
  const std::string arms = "/api/v1/studies/digits-or-shelves";
  EXPECT_TRUE(
      body_of(client->Get("/s/digits-or-shelves/welcome"), 200, "Welcome")["widget"].is_null());
  std::map<std::string, int> ways;
  for (int i = 0; i < 6; ++i) {
    const auto entry = post(arms + "/participants", json::object());
    EXPECT_EQ(entry->body.find("is-best"), std::string::npos) << "nobody is told of arms";
    const auto person = body_of(entry, 201, "Enrolment");
    ++ways[person["widget"].get<std::string>() + " " + person["best_digit"].dump()];
    const auto& page = person["pages"][0];
    json body = answer(page, i + 1);
    const bool shelves = person["widget"] == "shelves";
    if (!shelves) body.erase("shelves");
    for (const auto& image : page["images"]) {
      const auto slot = image["slot"].get<int>();
      if (!shelves) body["digits"][std::to_string(slot)] = slot + 1;
    }
    body_of(put(page_of(person, 0), body), 200, "AnswerReply");
    auto other = body;
    other["answer_id"] = uuid(100 + i);
    other[shelves ? "digits" : "shelves"] = other[shelves ? "shelves" : "digits"];
    other.erase(shelves ? "shelves" : "digits");
    EXPECT_EQ(error_of(put(page_of(person, 0), other), 400), "bad_value");
  }
  EXPECT_EQ(ways,
            (std::map<std::string, int>{{"numeric 1", 2}, {"numeric 9", 2}, {"shelves null", 2}}));
  const auto people = body_of(researcher->Get(arms + "/participants"), 200, "ParticipantList");
  std::map<std::string, int> counts;
  for (const auto& person : people["participants"]) ++counts[person["arm"]];
  EXPECT_EQ(counts,
            (std::map<std::string, int>{{"nine-is-best", 2}, {"one-is-best", 2}, {"shelves", 2}}));
}

}  // namespace
}  // namespace penumbra::server::http
