#include <gmock/gmock.h>

#include <set>

#include "study_file.h"

namespace penumbra::study {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

std::string fault_of(const std::function<void(json&)>& change) {
  json document = thesis_document();
  change(document);
  return field_at_fault([&] { parse_study(document); });
}

TEST(Study, TheThesisStudyHasItsSixScenesAndTheReferenceAmongThePictures) {
  const Study study = parse_study(thesis_document());
  EXPECT_EQ(study.id, "thesis-2007");
  EXPECT_THAT(study.languages, ElementsAre("en", "nl"));
  std::vector<std::string> scenes;
  for (const Page& page : study.pages) {
    scenes.push_back(page.scene);
    std::set<std::string> ids;
    for (const Picture& picture : page.pictures) ids.insert(picture.id);
    EXPECT_TRUE(ids.contains("reference"));
    EXPECT_EQ(ids.size(), page.pictures.size());
  }
  EXPECT_THAT(scenes, ElementsAre("car", "boxes", "disco-box", "island", "warehouse-inside",
                                  "warehouse-outside"));
  EXPECT_EQ(study.arms.front().widget, Widget::shelves);
  EXPECT_EQ(study.difficulty.labels.size(), 5u);
}

TEST(Study, EveryFaultIsNamedByItsPath) {
  EXPECT_EQ(fault_of([](json& d) { d["colour"] = 1; }), "colour");
  EXPECT_EQ(fault_of([](json& d) { d["pages"][2]["camra"] = "x"; }), "pages[2].camra");
  EXPECT_EQ(fault_of([](json& d) { d["pages"][2]["reference"] = "visible"; }),
            "pages[2].reference");
  EXPECT_EQ(fault_of([](json& d) { d["picture"]["width"] = "wide"; }), "picture.width");
  EXPECT_EQ(fault_of([](json& d) { d["picture"]["width"] = 100000; }), "picture.width");
  EXPECT_EQ(fault_of([](json& d) { d["picture"]["supersampling"] = 3; }), "picture.supersampling");
  EXPECT_EQ(fault_of([](json& d) { d["question"].erase("nl"); }), "question.nl");
  EXPECT_EQ(fault_of([](json& d) { d["labels"]["most"]["fr"] = "x"; }), "labels.most.fr");
  EXPECT_EQ(fault_of([](json& d) { d["difficulty"]["labels"].erase(4); }), "difficulty.labels");
  EXPECT_EQ(fault_of([](json& d) { d["difficulty"]["labels"][3].erase("en"); }),
            "difficulty.labels[3].en");
  EXPECT_EQ(fault_of([](json& d) { d["pages"].push_back(d["pages"][0]); }), "pages[6].id");
  const std::size_t techniques = thesis_document()["techniques"].size();
  EXPECT_EQ(fault_of([](json& d) { d["techniques"].push_back("shadow-map"); }),
            "techniques[" + std::to_string(techniques) + "]");
  EXPECT_EQ(fault_of([](json& d) { d["techniques"] = json::array({"shadow-map"}); }), "techniques");
  EXPECT_EQ(fault_of([](json& d) { d["techniques"][0]["parameters"]["bias"] = json::array(); }),
            "techniques[0].parameters.bias");
  EXPECT_EQ(fault_of([](json& d) { d["pages"][1]["reference"] = "hidden"; }), "pages[1].reference");
  EXPECT_EQ(fault_of([](json& d) { d["repeats"] = json::array({"car", "cart"}); }), "repeats[1]");
  EXPECT_EQ(fault_of([](json& d) { d["analysis"]["alpha"] = 1.5; }), "analysis.alpha");
  EXPECT_EQ(fault_of([](json& d) { d["completion"]["url"] = "javascript:alert(1)"; }),
            "completion.url");
}

TEST(Study, WhatIsNoJsonOrNoObjectIsRefused) {
  EXPECT_THROW(parse_study(std::string("{\"id\": ")), Error);
  EXPECT_THROW(parse_study(std::string("[1e999]")), Error);
  EXPECT_THROW(parse_study(json::array()), Error);
  EXPECT_THROW(parse_study(std::string(100000, '[')), Error);
}

TEST(Study, TheHashFollowsTheMeaningAndNotTheNotation) {
  const json document = thesis_document();
  const std::string hash = study_hash(parse_study(document));
  EXPECT_EQ(hash.size(), 64u);
  EXPECT_EQ(study_hash(parse_study(document.dump(7))), hash);
  json other = document;
  other["analysis"]["alpha"] = 0.01;
  EXPECT_NE(study_hash(parse_study(other)), hash);
}

TEST(Study, TheHashIsSha256OfTheCanonicalDocument) {
  // Python 3: hashlib.sha256(json.dumps(document, sort_keys=True, separators=(",", ":"),
  //                                     ensure_ascii=False).encode()).hexdigest()
  json small = thesis_document();
  for (const char* key : {"introduction", "thanks", "title", "question"}) {
    small[key] = {{"en", "x"}};
  }
  small["languages"] = {"en"};
  small["consent"] = {{"version", "1"}, {"text", {{"en", "x"}}}};
  small["labels"] = {{"most", {{"en", "m"}}}, {"least", {{"en", "l"}}}};
  small["difficulty"] = {
      {"question", {{"en", "q"}}},
      {"labels",
       json::array({{{"en", "1"}}, {{"en", "2"}}, {{"en", "3"}}, {{"en", "4"}}, {{"en", "5"}}})}};
  small["techniques"] = {"a", "b"};
  small["pages"] = json::array({{{"scene", "s"}}});
  for (const char* key :
       {"analysis", "completion", "id_parameters", "phones_allowed", "picture", "widget"}) {
    small.erase(key);
  }
  EXPECT_EQ(study_hash(parse_study(small)),
            "ad136287bea459f27eaf562667859fd1fb1d7ab88da5fc3e8c091554ab962019");
}

TEST(Study, RendersAreListedOnceAndInTheOrderOfPages) {
  json document = thesis_document();
  document["pages"][0]["reference"] = "shown";
  document["practice"] = {{"scene", "car"}, {"techniques", {"reference", "none"}}};
  const Study study = parse_study(document);
  const auto renders = all_renders(study);
  // Six pages, and `none` of the practice page; its reference and the shown one are not new.
  EXPECT_EQ(renders.size(), 6 * document["techniques"].size() + 1);
  EXPECT_EQ(renders[1]["technique"], "none");
  EXPECT_EQ(renders[2]["scene"], "car");
  EXPECT_EQ(renders[2]["technique"], "shadow-map");
  EXPECT_EQ(renders[2]["width"], 600);
  EXPECT_EQ(renders[2]["supersampling"], 4);
  EXPECT_FALSE(renders[2].contains("camera"));
  EXPECT_TRUE(page_renders(study, study.pages[0]).shown_reference.has_value());
  EXPECT_FALSE(page_renders(study, study.pages[1]).shown_reference.has_value());
}

TEST(Study, AHiddenReferenceIsRankedLikeTheOthers) {
  json document = thesis_document();
  document["techniques"] = {"shadow-map", "shadow-volumes"};
  document["pages"][0]["reference"] = "hidden";
  const Study study = parse_study(document);
  ASSERT_EQ(study.pages[0].pictures.size(), 3u);
  EXPECT_EQ(study.pages[0].pictures[2].technique, "reference");
  EXPECT_FALSE(page_renders(study, study.pages[0]).shown_reference.has_value());
}

TEST(Study, TheWelcomeTellsNeitherTechniquesNorScenesNorTheCompletionCode) {
  const Study study = parse_study(thesis_document());
  const json welcome = welcome_document(study);
  const std::string text = welcome.dump();
  for (const Page& page : study.pages) {
    EXPECT_EQ(text.find("\"" + page.scene), std::string::npos) << page.scene;
    for (const Picture& picture : page.pictures) {
      EXPECT_EQ(text.find(picture.technique + "\""), std::string::npos) << picture.technique;
      EXPECT_EQ(text.find("\"" + picture.label + "\""), std::string::npos) << picture.label;
    }
  }
  EXPECT_EQ(text.find(study.completion.complete.code), std::string::npos);
  EXPECT_EQ(welcome["page_count"], 6);
  EXPECT_EQ(welcome["texts"]["nl"]["most_label"], "meest realistisch");
  EXPECT_EQ(welcome["texts"]["en"]["difficulty_labels"].size(), 5u);
}

}  // namespace
}  // namespace penumbra::study
