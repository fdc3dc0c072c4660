// What every technique must do, whatever its family. A technique that is added to its folder is
// tested here without a line being written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "renderer/error.h"
#include "renderer/metrics/metrics.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/presets.h"
#include "techniques/registry.h"
#include "tests/conformance/scenes.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::techniques {
TechniqueDescription describe_template();
}

namespace penumbra {
namespace {

using test::box_on_ground;
using test::covered_ground;
using test::open_ground;

const std::vector<TechniqueDescription>& subjects() {
  static const std::vector<TechniqueDescription> list = [] {
    auto all = techniques::all();
    TechniqueDescription described = techniques::describe_template();
    described.id = "template";
    auto example = techniques::finish_descriptions({described});
    example.front().files = all.front().files;
    all.push_back(example.front());
    return all;
  }();
  return list;
}

RenderRequest request_for(const TechniqueDescription& technique, Scene scene,
                          std::uint32_t size = 64) {
  RenderRequest request;
  request.scene = std::make_shared<const Scene>(std::move(scene));
  request.technique = &technique;
  request.width = request.height = size;
  request.light_samples = 32;
  request.visibility = true;
  return request;
}

class Conformance : public testing::TestWithParam<std::size_t> {
 protected:
  const TechniqueDescription& technique() const { return subjects()[GetParam()]; }
  bool casts_shadows() const { return technique().family != "none"; }
};

double mean_judged(const RenderResult& result) {
  double sum = 0.0;
  double weight = 0.0;
  for (std::size_t i = 0; i < result.visibility.pixels.size(); ++i) {
    if (result.judged.pixels[i] < 0.5f) continue;
    sum += static_cast<double>(result.visibility.pixels[i]);
    weight += 1.0;
  }
  EXPECT_GT(weight, 100.0) << "the scene shows too little";
  return sum / weight;
}

TEST_P(Conformance, an_open_point_is_lit) {
  EXPECT_NEAR(mean_judged(test::renderer().render(request_for(technique(), open_ground()))), 1.0,
              1e-6);
}

TEST_P(Conformance, an_enclosed_point_is_dark) {
  const double mean =
      mean_judged(test::renderer().render(request_for(technique(), covered_ground())));
  EXPECT_NEAR(mean, casts_shadows() ? 0.0 : 1.0, 0.01);
}

TEST_P(Conformance, visibility_is_finite_and_between_0_and_1) {
  const RenderResult result = test::renderer().render(request_for(technique(), box_on_ground()));
  EXPECT_EQ(result.non_finite_pixels, 0u);
  EXPECT_THAT(result.visibility.pixels,
              testing::Each(testing::AllOf(testing::Ge(0.0f), testing::Le(1.0f + 1e-6f))));
}

TEST_P(Conformance, every_kind_of_light_gives_a_finite_picture_or_a_typed_error) {
  for (const LightKind kind : {LightKind::point, LightKind::directional}) {
    Scene scene = box_on_ground();
    scene.lights[0].kind = kind;
    if (kind == LightKind::directional) scene.lights[0].extent.radius = 0.5;  // degrees
    try {
      const RenderResult result = test::renderer().render(request_for(technique(), scene));
      EXPECT_EQ(result.non_finite_pixels, 0u);
      EXPECT_LT(mean_judged(result), casts_shadows() ? 0.999 : 1.001);
      EXPECT_GT(mean_judged(result), 0.5);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, "unsupported") << error.what();
    }
  }
}

TEST_P(Conformance, every_diagnostic_picture_draws) {
  for (const Diagnostic& diagnostic : technique().diagnostics) {
    SCOPED_TRACE(diagnostic.name);
    RenderRequest request = request_for(technique(), box_on_ground(), 32);
    request.diagnostic = diagnostic.name;
    const Image8 picture = test::renderer().render(request).diagnostic;
    EXPECT_EQ(picture.width, 32u);
    // Something is to be seen: not all pixels are alike.
    const auto first =
        std::vector<std::uint8_t>(picture.pixels.begin(), picture.pixels.begin() + 4);
    bool varies = false;
    for (std::size_t i = 4; i < picture.pixels.size(); ++i)
      varies = varies || picture.pixels[i] != first[i % 4];
    EXPECT_TRUE(varies);
  }
}

TEST_P(Conformance, the_ends_of_every_parameter_give_a_picture_or_a_typed_error) {
  for (const Parameter& parameter : technique().parameters) {
    std::vector<ParameterValue> ends;
    if (parameter.type == ParameterType::boolean) {
      ends = {true, false};
    } else if (parameter.type == ParameterType::choice) {
      for (const std::string& choice : parameter.choices) ends.emplace_back(choice);
    } else if (parameter.type == ParameterType::integer) {
      ends = {static_cast<std::int64_t>(parameter.minimum),
              static_cast<std::int64_t>(parameter.maximum)};
    } else {
      ends = {parameter.minimum, parameter.maximum};
    }
    for (const ParameterValue& end : ends) {
      SCOPED_TRACE(parameter.name + " = " + to_text(end));
      RenderRequest request = request_for(technique(), box_on_ground(), 16);
      request.parameters[parameter.name] = end;
      try {
        const RenderResult result = test::renderer().render(request);
        EXPECT_EQ(result.picture.width, 16u);
      } catch (const Error& error) {
        // Too large for the device, or not served: said so, and the renderer lives on.
        EXPECT_THAT(error.code, testing::AnyOf("unsupported", "bad_value", "device"));
        EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("validation")));
      }
    }
  }
}

TEST_P(Conformance, the_same_request_gives_the_same_bytes_whatever_was_drawn_before) {
  const RenderRequest request = request_for(technique(), box_on_ground());
  const RenderResult first = test::renderer().render(request);
  const RenderResult again = test::renderer().render(request);
  EXPECT_TRUE(tests::same(first.picture, again.picture));
  EXPECT_TRUE(tests::same(first.visibility, again.visibility));

  for (const TechniqueDescription& other : subjects())
    if (other.id != technique().id) {
      test::renderer().render(request_for(other, open_ground(), 32));
      break;
    }
  EXPECT_TRUE(tests::same(test::renderer().render(request).picture, first.picture));

  Renderer alone({.device = "", .validation = false});
  EXPECT_TRUE(tests::same(alone.render(request).picture, first.picture));
}

TEST_P(Conformance, two_cameras_agree_on_one_light) {
  Scene scene = box_on_ground();
  Camera moved = scene.cameras[0];
  moved.name = "moved";
  // 8 of 64 pixels of a picture 2 m wide.
  moved.position.x += 0.25;
  moved.target.x += 0.25;
  scene.cameras.push_back(moved);
  RenderRequest request = request_for(technique(), scene);
  const RenderResult from_first = test::renderer().render(request);
  request.camera = "moved";
  const RenderResult from_second = test::renderer().render(request);
  std::size_t compared = 0;
  std::size_t different = 0;
  for (std::uint32_t y = 0; y < 64; ++y)
    for (std::uint32_t x = 8; x < 64; ++x) {
      if (from_first.judged.at(x, y, 0) < 0.5f || from_second.judged.at(x - 8, y, 0) < 0.5f)
        continue;
      ++compared;
      const float difference =
          from_first.visibility.at(x, y, 0) - from_second.visibility.at(x - 8, y, 0);
      different += std::abs(difference) > 0.02f;
    }
  EXPECT_GT(compared, 2000u);
  // A sample on the very border of a shadow may fall to either side by rounding.
  EXPECT_LE(different, compared / 200);
}

TEST_P(Conformance, is_nearer_the_reference_than_no_shadows) {
  if (!casts_shadows()) {
    EXPECT_EQ(technique().id, "none");
    return;
  }
  const auto reference = techniques::resolve("reference");
  const auto none = techniques::resolve("none");
  const Image8 truth =
      test::renderer().render(request_for(*reference.technique, box_on_ground())).picture;
  const Image8 unshadowed =
      test::renderer().render(request_for(*none.technique, box_on_ground())).picture;
  const Image8 picture = test::renderer().render(request_for(technique(), box_on_ground())).picture;
  EXPECT_LT(tests::rms_y(picture, truth), 0.5 * metrics::rms_y(unshadowed, truth));
}

TEST_P(Conformance, comes_as_near_the_reference_as_its_folder_promises) {
  std::ifstream file(std::string(PENUMBRA_SOURCE_DIR) + "/techniques/" + technique().id +
                     "/expected.json");
  ASSERT_TRUE(file) << "techniques/" << technique().id << "/expected.json is missing";
  const auto expected = nlohmann::json::parse(file);
  const auto reference = techniques::resolve("reference");
  for (const auto& [id, bounds] : expected.items()) {
    SCOPED_TRACE(id);
    RenderRequest request = request_for(*reference.technique, open_ground(), 200);
    request.scene = scenes::load(id);
    request.light_samples = 64;
    request.visibility = false;
    const Image8 truth = test::renderer().render(request).picture;
    request.technique = &technique();
    EXPECT_LE(tests::rms_y(test::renderer().render(request).picture, truth),
              bounds.at("rms_y_max").get<double>());
  }
}

INSTANTIATE_TEST_SUITE_P(Every, Conformance, testing::Range<std::size_t>(0, subjects().size()),
                         [](const auto& instance) {
                           std::string name = subjects()[instance.param].id;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

std::string text_of_page(const std::string& path) {
  std::ifstream file(std::string(PENUMBRA_SOURCE_DIR) + "/" + path);
  EXPECT_TRUE(file) << path << " is missing";
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Rows of a page's tables by the name in code that they begin with; a name may begin several.
std::multimap<std::string, std::string> rows_of(const std::string& page) {
  std::multimap<std::string, std::string> rows;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("| `")) rows.emplace(line.substr(3, line.find('`', 3) - 3), line);
  return rows;
}

const std::multimap<std::string, std::string>& shared_rows() {
  static const auto rows = rows_of(text_of_page("techniques/common-parameters.md"));
  return rows;
}

/// Rows of the layouts' pages, whose parameters every technique with a layout has.
std::multimap<std::string, std::string> layout_rows(const TechniqueDescription& technique) {
  std::multimap<std::string, std::string> rows;
  for (const Parameter& parameter : technique.parameters)
    if (parameter.name == "layout")
      for (const std::string& layout : parameter.choices)
        rows.merge(rows_of(text_of_page("renderer/shadow_maps/layouts/" + layout + ".md")));
  return rows;
}

// Every parameter has a row with its default: on the technique's page, or on that of shared ones,
// or on a layout's. A default that changed in the code only is found here.
TEST_P(Conformance, the_page_names_every_parameter_with_its_default) {
  const auto own = rows_of(text_of_page("techniques/" + technique().id + "/README.md"));
  const auto of_layouts = layout_rows(technique());
  for (const Parameter& parameter : technique().parameters) {
    if (parameter.name == "gamma") continue;  // the frame's, explained once
    bool found = false;
    for (const auto* page : {&own, &shared_rows(), &of_layouts}) {
      const auto [first, last] = page->equal_range(parameter.name);
      for (auto row = first; row != last; ++row)
        EXPECT_THAT(row->second, testing::HasSubstr(to_text(parameter.default_value)));
      found = first != last;
      if (found) break;
    }
    EXPECT_TRUE(found) << "no page has a row for " << parameter.name;
  }
}

TEST(SharedParameters, BelongToSeveralTechniques) {
  for (const auto& [name, row] : shared_rows()) {
    const auto users = std::count_if(
        subjects().begin(), subjects().end(), [&](const TechniqueDescription& technique) {
          return std::any_of(technique.parameters.begin(), technique.parameters.end(),
                             [&](const Parameter& parameter) { return parameter.name == name; });
        });
    EXPECT_GE(users, 2) << row;
  }
}

}  // namespace
}  // namespace penumbra
