#include "techniques/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

#include "renderer/error.h"
#include "techniques/presets.h"

namespace penumbra::techniques {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAreArray;

TechniqueDescription description(const std::string& id) {
  TechniqueDescription made;
  made.id = id;
  made.label = id;
  made.title = id;
  made.parameters = {{.name = "taps",
                      .type = ParameterType::integer,
                      .default_value = std::int64_t{16},
                      .minimum = 1,
                      .maximum = 64,
                      .meaning = "filter reads"},
                     {.name = "radius", .default_value = std::int64_t{1}, .meaning = "width"}};
  made.create = [] { return std::unique_ptr<Technique>(); };
  return made;
}

std::vector<Preset> read(std::string_view text,
                         std::string_view path = "techniques/b/presets.json") {
  const std::vector<EmbeddedFile> files{{path, text}};
  return read_presets(finish_descriptions({description("b"), description("a")}), files);
}

std::string refusal_of(std::string_view text) {
  try {
    read(text);
  } catch (const Error& error) {
    return error.code + ": " + error.what();
  }
  return "accepted";
}

std::vector<std::string> names_of(const std::vector<Parameter>& parameters) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) names.push_back(parameter.name);
  return names;
}

TEST(Registry, HoldsEveryFolderOfTechniquesButTheTemplate) {
  std::vector<std::string> folders;
  const std::filesystem::path root = std::filesystem::path(PENUMBRA_SOURCE_DIR) / "techniques";
  for (const auto& entry : std::filesystem::directory_iterator(root))
    if (std::filesystem::exists(entry.path() / "technique.cpp") &&
        entry.path().filename() != "template")
      folders.push_back(entry.path().filename());
  std::vector<std::string> ids;
  for (const TechniqueDescription& technique : all()) ids.push_back(technique.id);
  EXPECT_THAT(ids, UnorderedElementsAreArray(folders));
  EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
}

TEST(Pages, ShowTheirTechniqueInPicturesThatAreThere) {
  const std::filesystem::path root = std::filesystem::path(PENUMBRA_SOURCE_DIR) / "techniques";
  const std::regex picture(R"(!\[[^\]]*\]\(([^)]+)\))");
  for (const auto& technique : techniques::all()) {
    std::ifstream file(root / technique.id / "README.md");
    const std::string page((std::istreambuf_iterator<char>(file)), {});
    int pictures = 0;
    for (std::sregex_iterator found(page.begin(), page.end(), picture), end; found != end;
         ++found, ++pictures)
      EXPECT_TRUE(std::filesystem::exists(root / technique.id / (*found)[1].str()))
          << technique.id << ": " << (*found)[1];
    EXPECT_GE(pictures, 1) << technique.id;
  }
}

/// Of a folder's files, by their names.
std::map<std::string, std::string> texts_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path());
    texts[entry.path().filename()] = {std::istreambuf_iterator<char>(file), {}};
  }
  return texts;
}

// What is repeated in every technique is what somebody has to write to try an idea.
TEST(Template, IsAFewLines) {
  std::size_t lines = 0;
  for (const auto& [name, text] :
       texts_in(std::filesystem::path(PENUMBRA_SOURCE_DIR) / "techniques/template")) {
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines += line.empty() ? 0 : 1;
  }
  EXPECT_GT(lines, 20u);
  EXPECT_LE(lines, 55u);
}

TEST(Template, BecomesATechniqueOfItsOwnAndNothingElseIsTouched) {
  namespace fs = std::filesystem;
  const fs::path root = PENUMBRA_SOURCE_DIR;
  std::string pattern = fs::temp_directory_path() / "penumbra-template-XXXXXX";
  ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
  const fs::path copy = pattern;
  fs::create_directories(copy / "scripts");
  fs::create_directories(copy / "techniques");
  fs::copy(root / "scripts/new-technique", copy / "scripts");
  fs::copy(root / "techniques/template", copy / "techniques/template");
  const auto before = texts_in(copy / "techniques/template");

  const std::string command =
      "'" + (copy / "scripts/new-technique").string() + "' sun-dial > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(texts_in(copy / "techniques/template"), before);
  const auto made = texts_in(copy / "techniques/sun-dial");
  EXPECT_EQ(made.size(), before.size());
  for (const auto& [name, text] : made)
    EXPECT_EQ(text.find("emplate"), std::string::npos) << name << ":\n" << text;
  EXPECT_THAT(made.at("technique.cpp"), HasSubstr("TechniqueDescription describe_sun_dial() {"));
  EXPECT_THAT(made.at("technique.cpp"), HasSubstr("create_technique<SunDial>"));
  EXPECT_EQ(std::distance(fs::directory_iterator(copy / "techniques"), {}), 2);
  fs::remove_all(copy);
}

TEST(Registry, ResolvesEveryPresetItOffers) {
  std::set<std::string> ids;
  for (const TechniqueDescription& technique : all()) ids.insert(technique.id);
  for (const Preset& preset : presets()) {
    EXPECT_TRUE(ids.insert(preset.id).second) << preset.id << " is taken twice";
    const Resolved resolved = resolve(preset.id);
    EXPECT_EQ(resolved.technique->id, preset.technique);
    for (const auto& [name, value] : preset.parameters)
      EXPECT_EQ(resolved.parameters.at(name), value) << preset.id << " " << name;
  }
}

TEST(Registry, RefusesUnknownTechniquesAndListsWhatThereIs) {
  try {
    resolve("radiosity");
    FAIL() << "an unknown technique was found";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "not_found");
    EXPECT_EQ(error.field, "technique");
    for (const TechniqueDescription& technique : all())
      EXPECT_THAT(error.what(), HasSubstr(technique.id));
  }
}

TEST(Descriptions, StandInOrderOfIdAndEndWithTheCommonParameters) {
  const auto list = finish_descriptions({description("b"), description("a")});
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].id, "a");
  EXPECT_EQ(list[1].id, "b");
  EXPECT_THAT(names_of(list[0].parameters), ElementsAre("taps", "radius", "gamma"));
  EXPECT_EQ(list[0].shader, "techniques/a/shadow.glsl");
}

TEST(Descriptions, GetDefaultsOfTheDeclaredType) {
  const auto list = finish_descriptions({description("a")});
  EXPECT_EQ(list[0].parameters[1].default_value, ParameterValue(1.0));
}

TEST(Descriptions, WithDefectsStopTheProgram) {
  const auto defect = [](auto change) {
    TechniqueDescription broken = description("a");
    change(broken);
    try {
      finish_descriptions({broken});
    } catch (const std::logic_error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  using Description = TechniqueDescription;
  EXPECT_EQ(defect([](Description& d) { d.parameters[0].default_value = std::int64_t{65}; }),
            "technique a, parameter taps: default: parameter taps must be a whole number from 1 to "
            "64, not \"65\"");
  EXPECT_EQ(defect([](Description& d) { d.parameters[0].maximum = 0; }),
            "technique a, parameter taps: minimum is above maximum");
  EXPECT_EQ(defect([](Description& d) { d.parameters[1].name = "taps"; }),
            "technique a declares parameter taps twice");
  EXPECT_EQ(defect([](Description& d) { d.parameters[1].name = "gamma"; }),
            "technique a declares parameter gamma twice");
  EXPECT_EQ(defect([](Description& d) { d.parameters[1].meaning.clear(); }),
            "technique a, parameter radius: has no meaning");
  EXPECT_EQ(defect([](Description& d) { d.parameters[1].scale = ParameterScale::logarithmic; }),
            "technique a, parameter radius: a logarithmic range must begin above 0");
  EXPECT_EQ(defect([](Description& d) { d.create = nullptr; }), "technique a cannot be created");
  EXPECT_THROW(finish_descriptions({description("a"), description("a")}), std::logic_error);
}

TEST(Presets, KeepWhatTheySayInTheDeclaredTypes) {
  const auto presets = read(R"([{"id": "b-64", "label": "B64", "title": "B, 64 taps",
    "source": "a paper", "parameters": {"taps": 64.0, "gamma": "off"}}])");
  ASSERT_EQ(presets.size(), 1u);
  EXPECT_EQ(presets[0].technique, "b");
  EXPECT_EQ(presets[0].label, "B64");
  EXPECT_EQ(presets[0].parameters,
            (ParameterValues{{"taps", std::int64_t{64}}, {"gamma", std::string("off")}}));
}

TEST(Presets, OfNobodysFolderAreNotRead) {
  EXPECT_TRUE(read("[]").empty());
  EXPECT_TRUE(read("not even JSON", "techniques/template/presets.json").empty());
}

TEST(Presets, ThatAreBrokenNameFolderPresetAndKey) {
  const std::string file = "unreadable: techniques/b/presets.json: ";
  const auto preset = [](const std::string& id, const std::string& parameters) {
    return R"({"id": ")" + id + R"(", "label": "L", "title": "T", "source": "S", "parameters": )" +
           parameters + "}";
  };
  EXPECT_THAT(refusal_of("[{"), HasSubstr(file));
  EXPECT_EQ(refusal_of("{}"), file + "must be an array of presets");
  EXPECT_EQ(refusal_of("[1]"), file + "every preset must be an object");
  EXPECT_EQ(refusal_of(R"([{"label": "L"}])"), file + "\"id\" must be a text");
  EXPECT_EQ(refusal_of(R"([{"id": "p", "label": 3}])"),
            file + "preset p: \"label\" must be a text");
  EXPECT_EQ(refusal_of("[" + preset("p", R"({"tap": 3})") + "]"),
            file + "preset p: there is no parameter tap here; there are: taps, radius, gamma");
  EXPECT_EQ(refusal_of("[" + preset("p", R"({"taps": 65})") + "]"),
            file + "preset p: parameter taps must be a whole number from 1 to 64, not \"65\"");
  EXPECT_EQ(refusal_of("[" + preset("p", R"({"taps": [1]})") + "]"),
            file + "preset p: parameter taps must be true, false, a number or a string, not [1]");
  EXPECT_EQ(refusal_of("[" + preset("p", "3") + "]"),
            file + "preset p: parameters must be an object");
  EXPECT_EQ(refusal_of("[" + preset("a", "{}") + "]"),
            file + "id a is taken already by technique a");
  EXPECT_EQ(refusal_of("[" + preset("p", "{}") + "," + preset("p", "{}") + "]"),
            file + "id p is taken already by techniques/b/presets.json");
  EXPECT_EQ(refusal_of(R"([{"id": "p", "label": "L", "title": "T", "source": "S"}])"),
            file + "preset p: \"parameters\" is missing");
  EXPECT_EQ(refusal_of(R"([{"id": "p", "label": "L", "title": "T", "source": "S", "extra": 1}])"),
            file + "preset p: unknown key \"extra\"");
}

}  // namespace
}  // namespace penumbra::techniques
