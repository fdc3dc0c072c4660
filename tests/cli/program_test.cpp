// Runs the built program as a person or a script would.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "renderer/image.h"
#include "scenes/library.h"
#include "scenes/picture_io.h"
#include "server/files/durable_file.h"
#include "techniques/registry.h"
#include "tests/cli/program.h"

namespace penumbra {
namespace {

using nlohmann::json;
using server::read_whole;
using testing::HasSubstr;

TEST_F(ProgramTest, answers_wrong_usage_with_state_2_and_the_argument_at_fault) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "subcommand"},
      {"paint", "paint"},
      {"render", "SCENE"},
      {"render boxes none --width 0", "width must be an integer from 1 to 16384"},
      {"render boxes none --width 1e3", "width"},
      {"render boxes none --height 100000", "height"},
      {"render boxes none --supersampling 2", "1, 4, 16"},
      {"render boxes none --set nonsense", "--set takes name=value"},
      {"render boxes none --set nonsense=1", "nonsense"},
      {"render boxes none --light nonsense=1", "NAME.key=value"},
      {"render boxes none --out picture.bmp", ".png"},
      {"render no-such-scene none", "half-plane"},
      {"render boxes no-such-technique", "none"},
      {"render boxes none --colour red", "--colour"},
      {"measure boxes none --frames 0", "frames"},
      {"compare a.png b.png", "a.png"},
      {"serve --port 70000", "--port"},
      {"statistics", "RESPONSES"}};
  for (const auto& [arguments, named] : cases) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments << ": " << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(named)) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
  }
}

TEST_F(ProgramTest, serves_until_a_signal_and_then_ends_in_order) {
  for (const std::string signal : {"HUP", "TERM", "INT"}) {
    const std::string out = "out-" + signal;
    const Outcome outcome = run("serve --port 0 --ops-port 0 --data data >" + out +
                                " 2>log & p=$!; for i in $(seq 200); do test -s " + out +
                                " && break; sleep 0.1; done; test -s " + out +
                                " || echo silent; kill -" + signal + " $p; wait $p; echo state $?");
    EXPECT_EQ(outcome.out, "state 0\n") << signal;
    EXPECT_THAT(read_whole(path("log")).value_or(""),
                HasSubstr("health and metrics on 127.0.0.1:"));
  }
}

TEST_F(ProgramTest, lists_exactly_the_scenes_and_techniques_there_are) {
  const json scenes = json::parse(run("scenes --json").out);
  std::vector<std::string> ids;
  for (const json& scene : scenes.at("scenes")) ids.push_back(scene.at("id"));
  std::vector<std::string> built_in;
  for (const auto& info : penumbra::scenes::built_in()) built_in.push_back(info.id);
  EXPECT_EQ(ids, built_in);

  const json techniques = json::parse(run("techniques --json").out);
  ASSERT_EQ(techniques.at("techniques").size(), penumbra::techniques::all().size());
  for (const json& technique : techniques.at("techniques"))
    EXPECT_EQ(technique.at("parameters").at("type"), "object");
  EXPECT_THAT(run("techniques").out, HasSubstr("shadow-map"));
}

TEST_F(ProgramTest, tells_which_lights_each_layout_serves) {
  const json rows = json::parse(run("techniques --matrix --json").out).at("matrix");
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [](const json& row) { return row.at("technique") == "pcf"; });
  ASSERT_NE(found, rows.end());
  EXPECT_EQ(found->at("layouts").at("single"), (json{"spot", "directional", "point"}));
  EXPECT_EQ(found->at("layouts").at("cascaded"), json::array({"directional"}));
  EXPECT_EQ(found->at("layouts").at("iasm"), json::array({"directional"}));
  // A table of sums needs an image, which tiles are not.
  for (const json& row : rows)
    EXPECT_EQ(row.at("layouts").at("iasm-gpu").empty(), row.at("technique") == "savsm") << row;
  for (const json& row : rows) EXPECT_NE(row.at("technique"), "shadow-volumes");
  EXPECT_THAT(run("techniques --matrix").out, HasSubstr("cascaded"));
}

TEST_F(ProgramTest, prints_one_json_document_also_when_it_fails) {
  const Outcome outcome = run("render boxes none --width 0 --json");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(json::parse(outcome.out).at("error").at("field"), "width");
}

TEST_F(ProgramTest, survives_arguments_of_any_bytes) {
  std::ofstream(path("g\xe9o.obj")) << "mtllib \xe9.mtl\no \xe9\xff\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                       "usemtl \xfc\nf 1 2 3\n";
  const std::vector<std::pair<std::string, int>> cases{
      {"render g\xe9o.obj none --width 16 --height 16 --json", 0},
      {"import g\xe9o.obj --id geo --json", 0},
      {"plan g\xe9o.obj shadow-map --json", 0},
      {"import g\xe9o.obj --id \xe9 --json", 2},
      {"render \xe9 none --json", 2},
      {"render boxes \xe9 --json", 2},
      {"render boxes none --camera \xe9 --json", 2},
      {"render boxes shadow-map --set map_size=\xe9 --json", 2},
      {"render boxes shadow-map --set \xe9=\xe9 --json", 2},
      {"render boxes none --light \xe9.\xe9=\xe9 --json", 2},
      {"render boxes none --width \xe9 --json", 2},
      {"compare \xe9 \xe9 --json", 2},
      {"statistics g\xe9o.obj --json", 1},
      {"\xe9 --json", 2}};
  for (const auto& [arguments, status] : cases) {
    const Outcome outcome = run(arguments);
    EXPECT_TRUE(outcome.status == status || (status > 0 && outcome.status == 3 - status))
        << arguments << ": " << outcome.status << outcome.err;
    const json document = json::parse(outcome.out, nullptr, false);
    ASSERT_TRUE(document.is_object()) << arguments << ": " << outcome.out;
    if (document.contains("error") && document["error"].is_object()) {
      EXPECT_NE(document["error"]["code"], "internal") << arguments << outcome.out;
    }
  }
}

TEST_F(ProgramTest, tells_what_an_import_left_out_in_renders_and_lists) {
  std::ofstream(path("m.obj")) << "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2 3\n";
  const auto notes_of = [&](const std::string& arguments) {
    const Outcome outcome = run(arguments + " --json");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    json document = json::parse(outcome.out);
    if (!document.contains("scenes")) return document.at("notes").dump();
    return document.at("scenes").back().at("notes").dump();
  };
  const std::string size = " --width 16 --height 16 --light-samples 16";
  for (const std::string& arguments :
       {std::string("import m.obj --id kept"), "render m.obj none" + size,
        "render kept none --data data" + size, "measure kept none --frames 1 --data data" + size,
        std::string("scenes --data data")})
    EXPECT_THAT(notes_of(arguments), testing::AllOf(HasSubstr("gone.mtl"), HasSubstr("is a line")))
        << arguments;
}

TEST_F(ProgramTest, compares_all_bits_light_and_says_what_becomes_of_alpha) {
  using penumbra::Image8;
  Image8 a(32, 32, 4, 100);
  for (std::size_t i = 3; i < a.pixels.size(); i += 4) a.pixels[i] = 255;
  penumbra::scenes::write_picture(path("a.png"), a);
  a.at(3, 3, 3) = 0;
  penumbra::scenes::write_picture(path("open.png"), a);
  const auto compared = [&](const std::string& files) {
    const Outcome outcome = run("compare " + files + " --json");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out);
  };
  const json alpha = compared("a.png open.png");
  EXPECT_EQ(alpha.at("rms_y"), 0.0);
  EXPECT_THAT(alpha.at("notes").dump(), HasSubstr("open.png has 1 pixels that are not opaque"));
  EXPECT_THAT(compared("a.png a.png").at("notes").dump(), testing::Not(HasSubstr("opaque")));
  // 16 bits: a difference of 64 of 65535 everywhere is 64 / 257 levels.
  for (const auto& [name, level] : {std::pair("low.png", 25700), std::pair("high.png", 25764)}) {
    const auto output = OIIO::ImageOutput::create(path(name));
    ASSERT_TRUE(output && output->open(path(name), {16, 16, 3, OIIO::TypeDesc::UINT16}));
    const std::vector<std::uint16_t> pixels(16 * 16 * 3, static_cast<std::uint16_t>(level));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT16, pixels.data()));
  }
  const json fine = compared("low.png high.png");
  EXPECT_NEAR(fine.at("rms_y").get<double>(), 64.0 / 257.0, 1e-4);
  EXPECT_NEAR(fine.at("psnr").get<double>(), 20.0 * std::log10(255.0 * 257.0 / 64.0), 1e-3);
  // Linear light of a picture is the picture, but for its rounding to 8 bits.
  for (const char* name : {"p.png", "p.exr"})
    ASSERT_EQ(
        run(std::string("render half-plane none --width 32 --height 32 --out ") + name).status, 0);
  const json light = compared("p.exr p.png");
  EXPECT_LT(light.at("rms_y").get<double>(), 0.5);
  EXPECT_THAT(light.at("notes").dump(), HasSubstr("p.exr is in linear light"));
}

TEST_F(ProgramTest, draws_a_picture_of_the_size_asked_for) {
  const Outcome outcome =
      run("render half-plane none --width 80 --height 60 --out p.png --visibility v.exr --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json record = json::parse(outcome.out);
  EXPECT_EQ(record.at("status"), "done");
  EXPECT_EQ(record.at("request").at("width"), 80);
  EXPECT_TRUE(record.at("device").at("name").is_string());
  EXPECT_EQ(record.at("links").at("out"), "p.png");

  const penumbra::Image8 picture = penumbra::scenes::read_picture(path("p.png"));
  EXPECT_EQ(picture.width, 80u);
  EXPECT_EQ(picture.height, 60u);
  const penumbra::ImageF visibility = penumbra::scenes::decode_exr(*read_whole(path("v.exr")));
  EXPECT_EQ(visibility.width, 80u);
  // Without a technique everything is lit.
  for (const float value : visibility.pixels) ASSERT_EQ(value, 1.0f);
}

TEST_F(ProgramTest, draws_the_end_of_a_path_of_cameras_as_the_camera_there_draws_it) {
  std::ofstream(path("path.json")) << R"([{"position": [0, 9, 9]}, {"position": [2, 8, 7]}])";
  const std::string picture = "render boxes pcf --width 24 --height 24 --out ";
  const Outcome led = run(picture + "led.exr --camera-path path.json");
  ASSERT_EQ(led.status, 0) << led.err;
  ASSERT_EQ(run(picture + "put.exr --camera-set main.position=2,8,7").status, 0);
  ASSERT_EQ(run(picture + "own.exr").status, 0);
  EXPECT_EQ(read_whole(path("led.exr")), read_whole(path("put.exr")));
  EXPECT_NE(read_whole(path("led.exr")), read_whole(path("own.exr")));
  std::ofstream(path("path.json")) << R"([{"position": [2, 8, 7]}, {"field_of_view": 500}])";
  const Outcome wrong = run(picture + "wrong.exr --camera-path path.json");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("camera_path[1].field_of_view"));
}

TEST_F(ProgramTest, measures_how_much_changes_from_frame_to_frame_of_a_path) {
  const auto difference = [&](const std::string& technique) {
    const Outcome outcome = run("measure village " + technique +
                                " --width 160 --height 160 --light-samples 64 --frames 1 "
                                "--json --camera-path path.json");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const json quality = json::parse(outcome.out).at("quality");
    return quality.value("frame_difference", json("not told"));
  };
  // The eye turns where it stands, so that what one frame shows the next shows elsewhere.
  std::ofstream(path("path.json")) << R"([{}, {"target": [0.4, 1, 0]}, {"target": [0.8, 1, 0]}])";
  const json still = difference("shadow-map");
  const json led = difference("shadow-map --set layout=cascaded --set cascade_snapping=false");
  ASSERT_TRUE(still.is_number() && led.is_number()) << still << led;
  EXPECT_LT(2.0 * still.get<double>(), led.get<double>());
  std::ofstream(path("path.json")) << R"([{"target": [0.4, 1, 0]}])";
  EXPECT_EQ(difference("shadow-map"), "not told");
}

TEST_F(ProgramTest, draws_the_same_bytes_every_time) {
  ASSERT_EQ(run("render half-plane shadow-map --width 64 --height 64 --out a.png").status, 0);
  ASSERT_EQ(run("render half-plane shadow-map --width 64 --height 64 --out b.png").status, 0);
  EXPECT_EQ(read_whole(path("a.png")), read_whole(path("b.png")));
}

TEST_F(ProgramTest, writes_every_format_it_names) {
  for (const std::string name : {"p.png", "p.jpg", "p.tif", "p.exr"}) {
    const Outcome outcome = run("render half-plane none --width 32 --height 32 --out " + name);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_GT(std::filesystem::file_size(path(name)), 100u) << name;
  }
  const auto tif = penumbra::scenes::read_picture(path("p.tif"));
  EXPECT_EQ(tif.pixels, penumbra::scenes::read_picture(path("p.png")).pixels);
}

TEST_F(ProgramTest, times_the_same_view_without_shadows_beside) {
  const Outcome outcome =
      run("measure boxes shadow-map --set map_size=2048 --width 32 --height 32 --light-samples 16 "
          "--frames 3 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json frame = json::parse(outcome.out).at("cost").at("frame_ms");
  // A map of 2048 x 2048 for 32 x 32 pixels takes many times what the pixels do.
  EXPECT_GT(frame.at("over_none").get<double>(), 2.0);
  EXPECT_DOUBLE_EQ(frame.at("over_none").get<double>(),
                   frame.at("median").get<double>() / frame.at("none_median").get<double>());
}

TEST_F(ProgramTest, measures_what_the_rules_of_a_plan_save) {
  const Outcome outcome = run("plan half-plane shadow-map --width 32 --height 32 --measure --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json measured = json::parse(outcome.out).at("measured");
  EXPECT_GT(measured.at("frame_ms"), 0.0);
  EXPECT_GT(measured.at("none_ms"), 0.0);
  EXPECT_DOUBLE_EQ(measured.at("technique_ms"),
                   measured.at("frame_ms").get<double>() - measured.at("none_ms").get<double>());
  std::vector<std::string> rules;
  for (const auto& rule : measured.at("rules")) {
    rules.push_back(rule.at("rule"));
    EXPECT_GT(rule.at("without_ms"), 0.0);
    EXPECT_DOUBLE_EQ(rule.at("saves_ms"),
                     rule.at("without_ms").get<double>() - measured.at("frame_ms").get<double>());
  }
  EXPECT_EQ(rules, (std::vector<std::string>{"lights", "surfaces", "casters", "textures"}));
}

TEST_F(ProgramTest, measures_cost_and_error) {
  const Outcome outcome =
      run("measure half-plane none --width 64 --height 64 --light-samples 64 --frames 3 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json record = json::parse(outcome.out);
  const json& cost = record.at("cost");
  EXPECT_EQ(cost.at("frame_ms").at("frames"), 3);
  EXPECT_GT(cost.at("frame_ms").at("median").get<double>(), 0.0);
  EXPECT_LE(cost.at("frame_ms").at("median"), cost.at("frame_ms").at("p95"));
  // lavapipe has no clocks to wait for, and `none` is its own measure.
  EXPECT_TRUE(cost.at("frame_ms").at("settled").get<bool>());
  EXPECT_EQ(cost.at("frame_ms").at("none_median"), cost.at("frame_ms").at("median"));
  EXPECT_EQ(cost.at("memory").at("over_none_bytes"), 0);  // `none` adds nothing over itself
  EXPECT_FALSE(cost.at("passes").empty());

  // Without shadows the error can only be shadow that is missing.
  const json& quality = record.at("quality");
  EXPECT_GT(quality.at("rms_y").get<double>(), 1.0);
  EXPECT_GT(quality.at("visibility_bias").get<double>(), 0.0);
  EXPECT_EQ(quality.at("false_shadow"), 0.0);
  EXPECT_GT(quality.at("missing_shadow").get<double>(), 0.05);
  EXPECT_LT(quality.at("reference_noise_rms_y").get<double>(), quality.at("rms_y").get<double>());
  EXPECT_EQ(quality.at("reference_id").get<std::string>().size(), 32u);
}

TEST_F(ProgramTest, finds_no_error_in_the_reference_itself) {
  const Outcome outcome = run(
      "measure half-plane reference --width 64 --height 64 --light-samples 64 --frames 1 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json record = json::parse(outcome.out);
  EXPECT_EQ(record.at("quality").at("rms_y"), 0.0);
  EXPECT_EQ(record.at("quality").at("visibility_rms"), 0.0);
  EXPECT_EQ(record.at("quality").at("reference_id"), record.at("id"));
}

TEST_F(ProgramTest, compares_pictures_as_their_closed_forms_say) {
  // Every pixel of Y differs by 10; PSNR = 20 log10(255 / 10).
  penumbra::scenes::write_picture(path("a.png"), penumbra::Image8(16, 16, 3, 100));
  penumbra::scenes::write_picture(path("b.png"), penumbra::Image8(16, 16, 3, 110));
  const json apart = json::parse(run("compare a.png b.png --json").out);
  EXPECT_NEAR(apart.at("rms_y").get<double>(), 10.0, 1e-9);
  EXPECT_NEAR(apart.at("psnr").get<double>(), 28.1308036086791, 1e-9);
  const json equal = json::parse(run("compare a.png a.png --json").out);
  EXPECT_EQ(equal.at("rms_y"), 0.0);
  EXPECT_TRUE(equal.at("psnr").is_null());
  EXPECT_NEAR(equal.at("ssim").get<double>(), 1.0, 1e-12);

  penumbra::scenes::write_picture(path("c.png"), penumbra::Image8(8, 16, 3, 110));
  EXPECT_EQ(run("compare a.png c.png").status, 2);
}

TEST_F(ProgramTest, exports_a_scene_that_comes_back_the_same) {
  ASSERT_EQ(run("export-scene half-plane --out half.glb").status, 0);
  const Outcome imported = run("import half.glb --id mine --data store --json");
  ASSERT_EQ(imported.status, 0) << imported.err;
  const auto original = penumbra::scenes::load("half-plane");
  EXPECT_EQ(json::parse(imported.out).at("hash"), penumbra::scenes::content_hash(*original));
  EXPECT_THAT(run("scenes --data store").out, HasSubstr("mine"));
  const Outcome drawn = run("render mine none --data store --width 32 --height 32 --json");
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(run("import half.glb --id ../mine --data store").status, 2);
  EXPECT_EQ(run("import half.glb --id boxes --data store").status, 2);
}

TEST_F(ProgramTest, finds_this_machine_able_to_work) {
  const Outcome outcome = run("doctor --json");
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  const json report = json::parse(outcome.out);
  EXPECT_TRUE(report.at("works"));
  EXPECT_FALSE(report.at("devices").empty());
}

TEST_F(ProgramTest, tells_what_else_it_knows_of_a_machine_without_a_driver) {
  const Outcome outcome =
      run("doctor --json", "VK_ICD_FILENAMES=none.json VK_DRIVER_FILES=none.json");
  EXPECT_EQ(outcome.status, 1);
  const json report = json::parse(outcome.out);
  EXPECT_FALSE(report.at("works"));
  EXPECT_TRUE(report.at("devices").empty());
  const json& checks = report.at("checks");
  EXPECT_FALSE(checks.at(0).at("fine"));
  EXPECT_THAT(checks.at(0).at("found").get<std::string>(), HasSubstr("no Vulkan driver"));
  EXPECT_TRUE(checks.at(1).at("fine")) << checks;
}

TEST_F(ProgramTest, says_which_device_is_not_there) {
  const Outcome outcome =
      run("render half-plane none --device no-such-device --width 8 --height 8");
  EXPECT_NE(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("no-such-device"));
}

TEST_F(ProgramTest, takes_options_from_the_environment) {
  const Outcome outcome = run("render half-plane none --height 20 --json", "PENUMBRA_WIDTH=24");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out).at("request").at("width"), 24);
}

}  // namespace
}  // namespace penumbra
