// Experiments over HTTP: measured by a process of the real program.
#include <gmock/gmock.h>

#include "tests/http/running_server.h"

namespace penumbra::server::http {
namespace {

using testing::HasSubstr;

class ExperimentsTest : public RunningServer {
 protected:
  httplib::Result start(const json& request) {
    return researcher->Post("/api/v1/experiments", request.dump(), "application/json");
  }

  const json small{{"kind", "sweep"},
                   {"scenes", {"sweep:1x100x3"}},
                   {"techniques", "shadow-map,vsm"},
                   {"sizes", {16, 24}},
                   {"run_ms", 5}};
};

TEST_F(ExperimentsTest, measure_and_report_for_the_researcher_alone) {
  const auto accepted = start(small);
  const json state = body_of(accepted, 202, "Experiment");
  const std::string at = accepted->get_header_value("Location");
  EXPECT_EQ(at, "/api/v1/experiments/" + state["id"].get<std::string>());
  EXPECT_EQ(error_of(client->Get(at), 401), "unauthorized");
  const json done = experiment_over(state["id"]);
  ASSERT_EQ(done["status"], "done") << done;
  EXPECT_EQ(done["progress"]["done"], 6);  // two sizes of none, shadow-map and vsm

  const auto rows = researcher->Get(at + "/results.csv");
  ASSERT_EQ(rows->status, 200);
  EXPECT_EQ(std::count(rows->body.begin(), rows->body.end(), '\n'), 7);
  const auto report = researcher->Get(at + "/report.html");
  ASSERT_EQ(report->status, 200);
  EXPECT_THAT(report->body, HasSubstr("<svg"));
  EXPECT_THAT(report->get_header_value("Content-Security-Policy"), HasSubstr("sandbox"));
  const auto figure = researcher->Get(at + "/figures/over-none.svg");
  ASSERT_EQ(figure->status, 200);
  EXPECT_EQ(figure->get_header_value("Content-Type"), "image/svg+xml");
  EXPECT_EQ(researcher->Get(at + "/figures/none-such.svg")->status, 404);
  EXPECT_EQ(researcher->Get(at + "/figures/..%2Frequest.json")->status, 404);
  const auto events = researcher->Get(at + "/events");
  ASSERT_TRUE(events);
  EXPECT_THAT(events->body, HasSubstr("event: experiment\n"));
  const json list = body_of(researcher->Get("/api/v1/experiments"), 200, "ExperimentList");
  ASSERT_EQ(list["experiments"].size(), 1u);
  restart();
  EXPECT_EQ(experiment_over(state["id"])["status"], "done");
}

TEST_F(ExperimentsTest, refuse_files_options_and_keys_that_there_are_not) {
  const std::vector<std::pair<json, std::string>> cases{
      {{{"kind", "paint"}}, "kind"},
      {json::object(), "kind"},
      {{{"kind", "sweep"}, {"scenes", "/etc/passwd"}}, "scenes"},
      {{{"kind", "sweep"}, {"scenes", {"model.glb"}}}, "scenes"},
      {{{"kind", "sweep"}, {"techniques", "--out=elsewhere"}}, "techniques"},
      {{{"kind", "sweep"}, {"out", "elsewhere"}}, "out"},
      {{{"kind", "sweep"}, {"sizes", json::array()}}, "sizes"},
      {{{"kind", "sweep"}, {"errors", "yes"}}, "errors"},
      {{{"kind", "claims"}, {"page", "elsewhere"}}, "page"},
      {{{"kind", "recommend"}}, "scene"},
      {{{"kind", "recommend"}, {"scene", "boxes"}, {"budget_ms", "much"}}, "budget_ms"},
      {{{"kind", "tradeoff"}}, "scene"},
      {{{"kind", "tradeoff"}, {"scene", "boxes"}, {"study", "none-such"}}, "study"},
      {{{"kind", "tradeoff"}, {"scene", "boxes"}, {"study", "../study"}}, "study"},
      {{{"kind", "tradeoff"}, {"scene", "boxes"}, {"study", 7}}, "study"},
      {{{"kind", "tradeoff"}, {"scene", "../x"}}, "scene"}};
  for (const auto& [request, field] : cases) {
    const auto answer = start(request);
    EXPECT_EQ(error_of(answer, 400), "bad_value") << request;
    EXPECT_EQ(json::parse(answer->body)["error"]["field"], field) << request;
  }
}

TEST_F(ExperimentsTest, push_techniques_to_where_they_break) {
  const json state = body_of(
      start({{"kind", "stability"}, {"techniques", "shadow-map"}, {"axes", {"small-picture"}}}),
      202, "Experiment");
  const json done = experiment_over(state["id"]);
  EXPECT_EQ(done["status"], "done");
  EXPECT_EQ(done["progress"]["done"], done["progress"]["total"]);
  const auto table =
      researcher->Get("/api/v1/experiments/" + state["id"].get<std::string>() + "/results.csv");
  EXPECT_EQ(table->status, 200);
  EXPECT_THAT(table->body, HasSubstr("shadow-map,small-picture,"));
}

TEST_F(ExperimentsTest, recommend_a_technique_for_a_scene) {
  const json asked = {{"kind", "recommend"}, {"scene", "sweep:1x100x1"}, {"size", 32},
                      {"run_ms", 5},         {"light_samples", 16},      {"memory_bytes", 100000}};
  const json state = body_of(start(asked), 202, "Experiment");
  ASSERT_EQ(experiment_over(state["id"])["status"], "done");
  const auto report =
      researcher->Get("/api/v1/experiments/" + state["id"].get<std::string>() + "/report.html");
  ASSERT_EQ(report->status, 200);
  EXPECT_THAT(report->body, HasSubstr("Recommendation"));
  // Its kind is among those that a form offers, with what it needs.
  const json list = body_of(researcher->Get("/api/v1/experiments"), 200, "ExperimentList");
  const auto kind = std::find_if(list["kinds"].begin(), list["kinds"].end(),
                                 [](const json& each) { return each["kind"] == "recommend"; });
  ASSERT_NE(kind, list["kinds"].end());
  EXPECT_EQ((*kind)["keys"][0],
            json({{"name", "scene"}, {"form", "text"}, {"required", true}, {"example", "boxes"}}));
}

TEST_F(ExperimentsTest, measure_claims) {
  const json state = body_of(start({{"kind", "claims"}, {"only", {"P05", "P07"}}, {"quick", true}}),
                             202, "Experiment");
  EXPECT_EQ(experiment_over(state["id"])["status"], "done");
  const auto table =
      researcher->Get("/api/v1/experiments/" + state["id"].get<std::string>() + "/results.csv");
  EXPECT_EQ(table->status, 200);
  EXPECT_THAT(table->body, HasSubstr("P05,"));
  EXPECT_THAT(table->body, HasSubstr("P07,"));
}

TEST_F(ExperimentsTest, tell_why_one_failed) {
  const json state =
      body_of(start({{"kind", "sweep"}, {"techniques", "paint"}}), 202, "Experiment");
  const json failed = experiment_over(state["id"]);
  EXPECT_EQ(failed["status"], "failed");
  EXPECT_EQ(failed["error"]["code"], "not_found");
}

TEST_F(ExperimentsTest, stop_when_deleted_and_go_on_after_a_restart) {
  // Hours of work: nothing but a stop ends it here.
  json large = small;
  large["scenes"] = "sweep:*";
  large["techniques"] = "none,shadow-map,vsm,pcss,esm";
  large["sizes"] = json::array({300, 600, 1200});
  const std::string first = body_of(start(large), 202, "Experiment")["id"];
  const std::string second = body_of(start(large), 202, "Experiment")["id"];
  restart();
  EXPECT_EQ(body_of(researcher->Get("/api/v1/experiments/" + second), 200, "Experiment")["status"],
            "queued");
  for (const std::string& id : {second, first}) {
    EXPECT_EQ(researcher->Delete("/api/v1/experiments/" + id)->status, 204);
    EXPECT_EQ(experiment_over(id)["status"], "stopped");
  }
  EXPECT_EQ(researcher->Delete("/api/v1/experiments/none-such")->status, 404);
}

}  // namespace
}  // namespace penumbra::server::http
