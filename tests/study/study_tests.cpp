#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <fstream>
#include <set>

#include "study_file.h"

namespace penumbra::study {
namespace study_tests {

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

TEST(Study, ItsSchemaForEditorsIsTheOneThatIsChecked) {
  std::ifstream file(PENUMBRA_SOURCE_DIR "/schema/study.schema.json");
  EXPECT_EQ(json::parse(file), study_schema())
      << "picture is " << study_schema()["properties"]["picture"];
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
  EXPECT_EQ(page_renders(study, study.pages[0]).shown_reference.size(), 1u);
  EXPECT_TRUE(page_renders(study, study.pages[1]).shown_reference.empty());
}

TEST(Study, AnOrbitTurnsTheCameraAboutItsCentre) {
  json document = thesis_document();
  document["techniques"] = {"none", "shadow-map"};
  document["pages"] = {{{"scene", "boxes"}},
                       {{"scene", "boxes"},
                        {"id", "turned"},
                        {"camera", "main"},
                        {"reference", "shown"},
                        {"orbit",
                         {{"centre", {1, 2, 3}},
                          {"distance", 10},
                          {"elevation", 0},
                          {"from", -90},
                          {"to", 90},
                          {"frames", 5}}}}};
  const Study study = parse_study(document);
  EXPECT_EQ(all_renders(study).size(), 2u + 3u * 5u);
  EXPECT_EQ(first_view(study.pages[0]), 0u);
  EXPECT_EQ(first_view(study.pages[1]), 2u);
  const auto still = page_renders(study, study.pages[0]);
  ASSERT_EQ(still.pictures[0].size(), 1u);
  EXPECT_FALSE(still.pictures[0][0].contains("camera_path"));
  const auto turned = page_renders(study, study.pages[1]);
  ASSERT_EQ(turned.pictures.size(), 2u);
  ASSERT_EQ(turned.shown_reference.size(), 5u);
  // Seen from the x axis below zero, from the z axis, and from the x axis beyond zero.
  const double root = 10.0 * std::sqrt(0.5);
  const std::vector<std::array<double, 3>> positions{
      {-9, 2, 3}, {1 - root, 2, 3 + root}, {1, 2, 13}, {1 + root, 2, 3 + root}, {11, 2, 3}};
  for (std::size_t view = 0; view < positions.size(); ++view) {
    const json& request = turned.pictures[1][view];
    EXPECT_EQ(request["technique"], "shadow-map");
    EXPECT_EQ(request["camera"], "main");
    ASSERT_EQ(request["camera_path"].size(), 1u);
    EXPECT_EQ(request["camera_path"][0]["target"], json({1, 2, 3}));
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(request["camera_path"][0]["position"][axis], positions[view][axis], 1e-9);
  }
  // Raised by 30 degrees: half the distance above the centre.
  document["pages"][1]["orbit"]["elevation"] = 30;
  const Study raised = parse_study(document);
  EXPECT_NEAR(page_renders(raised, raised.pages[1]).pictures[0][4]["camera_path"][0]["position"][1],
              7, 1e-9);
}

TEST(Study, FaultsOfAnOrbitAreNamed) {
  const auto with = [](const char* key, const json& value) {
    return fault_of([&](json& document) {
      auto& page = document["pages"][0];
      page["techniques"] = {"none", "shadow-map"};
      page["orbit"] = {{"centre", {0, 1, 0}}, {"distance", 5}};
      page["orbit"][key] = value;
    });
  };
  EXPECT_EQ(with("distance", 0), "pages[0].orbit.distance");
  EXPECT_EQ(with("centre", {0, 1}), "pages[0].orbit.centre");
  EXPECT_EQ(with("elevation", 90), "pages[0].orbit.elevation");
  EXPECT_EQ(with("frames", 1), "pages[0].orbit.frames");
  EXPECT_EQ(with("frames", 73), "pages[0].orbit.frames");
  EXPECT_EQ(with("to", -30), "pages[0].orbit.to");
  EXPECT_EQ(with("speed", 3), "pages[0].orbit.speed");
  EXPECT_EQ(fault_of([](json& document) {
              document["pages"][0]["orbit"] = {{"centre", {0, 1, 0}}, {"distance", 5}};
              document["pages"][0]["techniques"] = {
                  "none", {{"id", "mine"}, {"picture", std::string(64, 'a')}}};
            }),
            "pages[0].techniques[1].picture");
}

TEST(Study, AHiddenReferenceIsRankedLikeTheOthers) {
  json document = thesis_document();
  document["techniques"] = {"shadow-map", "shadow-volumes"};
  document["pages"][0]["reference"] = "hidden";
  const Study study = parse_study(document);
  ASSERT_EQ(study.pages[0].pictures.size(), 3u);
  EXPECT_EQ(study.pages[0].pictures[2].technique, "reference");
  EXPECT_TRUE(page_renders(study, study.pages[0]).shown_reference.empty());
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

}  // namespace study_tests
}  // namespace penumbra::study
