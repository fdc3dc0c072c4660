#include "study/study.h"

#include <algorithm>
#include <array>
#include <set>

#include "renderer/error.h"
#include "requests/schema.h"
#include "study/digest.h"
#include "study/faults.h"
#include "study/study_schema.h"

namespace penumbra::study {

namespace {

using nlohmann::json;

std::string indexed(const std::string& path, std::size_t index) {
  return path + "[" + std::to_string(index) + "]";
}

/// Reads texts and checks that they have the study's languages, no more and no fewer.
class TextReader {
 public:
  TextReader(const std::vector<std::string>& languages_, FaultList& faults_)
      : languages(languages_), faults(faults_) {}

  Texts read(const json& value, const std::string& path) const {
    auto texts = value.get<Texts>();
    for (const std::string& language : languages)
      if (!texts.contains(language))
        faults.add(
            bad_value(path + "." + language, "the study has this language; the text is missing"));
    for (const auto& [language, unused] : texts)
      if (std::find(languages.begin(), languages.end(), language) == languages.end())
        faults.add(bad_value(path + "." + language, "not one of the study's languages"));
    return texts;
  }

 private:
  const std::vector<std::string>& languages;
  FaultList& faults;
};

/// FNV-1a over the canonical text, 16 digits. It tells pictures apart; nothing secret depends on
/// it.
std::string parameters_hash(const json& parameters) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char byte : parameters.dump())
    hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3ull;
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[15 - i] = "0123456789abcdef"[(hash >> (4 * i)) & 15];
  return text;
}

Picture read_picture(const json& value, const std::string& path) {
  const json& keys = value.is_object() ? value : json{{"technique", value}};
  Picture picture;
  picture.technique = keys.value("technique", "");
  picture.own = keys.value("picture", "");
  if (picture.technique.empty() == picture.own.empty())
    throw bad_value(path, "needs either `technique` or, for a picture of your own, `picture`");
  if (!picture.own.empty() && !is_picture_name(picture.own))
    throw bad_value(path + ".picture",
                    "must be the SHA-256 that uploading the picture returned, or in a zip the name "
                    "of a file beside study.json");
  if (!picture.own.empty() && keys.contains("parameters"))
    throw bad_value(path + ".parameters", "a picture of your own has none");
  if (!picture.own.empty() && !keys.contains("id"))
    throw bad_value(path + ".id", "a picture of your own needs a name");
  picture.parameters = keys.value("parameters", json::object());
  picture.id = keys.value("id", picture.technique);
  picture.label = keys.value("label", picture.id);
  picture.parameters_hash = parameters_hash(picture.parameters);
  return picture;
}

std::vector<Picture> read_pictures(const json& list, const std::string& path) {
  std::vector<Picture> pictures;
  std::set<std::string> ids;
  for (std::size_t i = 0; i < list.size(); ++i) {
    pictures.push_back(read_picture(list[i], indexed(path, i)));
    if (!ids.insert(pictures.back().id).second) {
      throw bad_value(indexed(path, i), "two pictures are called `" + pictures.back().id +
                                            "`; give one of them another id");
    }
  }
  return pictures;
}

ReferenceUse read_reference(const std::string& use) {
  if (use == "hidden") return ReferenceUse::hidden;
  if (use == "shown") return ReferenceUse::shown;
  return use == "both" ? ReferenceUse::both : ReferenceUse::none;
}

std::optional<Expectation> read_expectation(const json& value, const std::vector<Picture>& pictures,
                                            const std::string& path) {
  if (value.is_null()) return std::nullopt;
  if (value.is_string()) return Expectation{true, {}, {}};
  Expectation expected{false, value.at("better"), value.at("worse")};
  for (const auto& [key, id] : {std::pair{"better", &expected.better}, {"worse", &expected.worse}})
    if (std::none_of(pictures.begin(), pictures.end(),
                     [wanted = id](const Picture& picture) { return picture.id == *wanted; }))
      throw bad_value(path + "." + key, "the page has no picture `" + *id + "`");
  if (expected.better == expected.worse)
    throw bad_value(path + ".worse", "is the same picture as `better`");
  return expected;
}

/// The camera of a page whose pictures can be turned.
std::optional<Orbit> read_orbit(const json& value, const std::vector<Picture>& pictures,
                                const std::string& path, const std::string& list_path) {
  if (value.is_null()) return std::nullopt;
  for (std::size_t i = 0; i < pictures.size(); ++i)
    if (!pictures[i].own.empty())
      throw bad_value(indexed(list_path, i) + ".picture",
                      "a picture of your own has one view, and the page's orbit more");
  Orbit orbit;
  orbit.centre = value.at("centre").get<std::array<double, 3>>();
  orbit.distance = value.at("distance").get<double>();
  orbit.elevation = value.value("elevation", orbit.elevation);
  orbit.from = value.value("from", orbit.from);
  orbit.to = value.value("to", orbit.to);
  orbit.frames = value.value("frames", orbit.frames);
  if (orbit.from == orbit.to) throw bad_value(path + ".to", "is where the orbit begins");
  return orbit;
}

Page read_page(const json& value, const json& common_techniques, const TextReader& texts,
               const std::string& path) {
  Page page;
  page.scene = value.at("scene").get<std::string>();
  page.id = value.value("id", page.scene);
  page.camera = value.value("camera", "");
  page.reference = read_reference(value.value("reference", ""));
  const bool own = value.contains("techniques");
  const std::string list_path = own ? path + ".techniques" : "techniques";
  page.pictures = read_pictures(own ? value.at("techniques") : common_techniques, list_path);
  page.orbit = read_orbit(value.value("orbit", json()), page.pictures, path + ".orbit", list_path);
  if (page.reference == ReferenceUse::hidden || page.reference == ReferenceUse::both) {
    for (const Picture& picture : page.pictures) {
      if (picture.id == "reference") {
        throw bad_value(path + ".reference", "the techniques already list `reference`");
      }
    }
    page.pictures.push_back(reference_picture());
  }
  if (page.pictures.size() < 2) {
    throw bad_value(list_path, "a page needs at least two pictures to rank");
  }
  page.expected =
      read_expectation(value.value("expected", json()), page.pictures, path + ".expected");
  if (value.contains("question"))
    page.question = texts.read(value.at("question"), path + ".question");
  else if (!page.counted())
    throw bad_value(path + ".question", "must ask for what is expected on this page");
  return page;
}

void read_pages(const json& document, const TextReader& texts, FaultList& faults, Study& study) {
  std::set<std::string> ids;
  const json& pages = document.at("pages");
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const std::string path = indexed("pages", i);
    faults.attempt([&] {
      study.pages.push_back(read_page(pages[i], document.at("techniques"), texts, path));
      if (!ids.insert(study.pages.back().id).second)
        throw bad_value(path + ".id", "two pages are called `" + study.pages.back().id + "`");
    });
  }
  if (!faults.all().empty()) return;  // repeats would name pages that could not be read
  const json repeats = document.value("repeats", json::array());
  for (std::size_t i = 0; i < repeats.size(); ++i) {
    const auto id = repeats[i].get<std::string>();
    const auto page = std::find_if(study.pages.begin(), study.pages.end(),
                                   [&](const Page& candidate) { return candidate.id == id; });
    if (page == study.pages.end()) throw bad_value(indexed("repeats", i), "no page is called so");
    if (study.pages.size() < 2)
      throw bad_value(indexed("repeats", i), "another page is needed between its two showings");
    if (!page->counted())
      throw bad_value(indexed("repeats", i), "is an attention item, which ranks nothing");
    study.repeats.push_back(static_cast<std::size_t>(page - study.pages.begin()));
  }
  if (document.contains("practice")) {
    study.practice = Practice{read_page(document.at("practice"), json(), texts, "practice")};
    study.practice->page.id = "practice";
  }
}

void read_demographics(const json& list, const TextReader& texts, Study& study) {
  std::set<std::string> ids;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string path = indexed("demographics", i);
    Demographic item;
    item.id = list[i].at("id").get<std::string>();
    if (!ids.insert(item.id).second) throw bad_value(path + ".id", "used twice");
    item.question = texts.read(list[i].at("question"), path + ".question");
    item.required = list[i].value("required", false);
    std::set<std::string> option_ids;
    const json& options = list[i].at("options");
    for (std::size_t j = 0; j < options.size(); ++j) {
      const std::string option_path = indexed(path + ".options", j);
      const auto id = options[j].at("id").get<std::string>();
      if (!option_ids.insert(id).second) throw bad_value(option_path + ".id", "used twice");
      item.options.push_back({id, texts.read(options[j].at("text"), option_path + ".text")});
    }
    study.demographics.push_back(std::move(item));
  }
}

/// The parameter that names a person: the one the study says, or a panel's own, or the first that
/// is no name of a study or session.
std::string person_parameter(const json& document, const std::vector<std::string>& parameters) {
  const auto has = [&](const std::string& name) {
    return std::find(parameters.begin(), parameters.end(), name) != parameters.end();
  };
  if (document.contains("person_parameter")) {
    const auto name = document.at("person_parameter").get<std::string>();
    if (!name.empty() && !has(name))
      throw bad_value("person_parameter", "must be one of id_parameters");
    return name;
  }
  for (const char* name : {"PROLIFIC_PID", "workerId"})
    if (has(name)) return name;
  const std::set<std::string> others{"STUDY_ID", "SESSION_ID", "assignmentId", "hitId"};
  const auto first = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const auto& name) { return !others.contains(name); });
  return first == parameters.end() ? "" : *first;
}

Consequence read_consequence(const json& value) {
  return value.value("consequence", "flag") == "flag" ? Consequence::flag : Consequence::screen_out;
}

CompletionCode read_code(const json& value) {
  return {value.value("code", ""), value.value("url", "")};
}

/// How people enter, are checked, and leave.
void read_participation(const json& document, Study& study) {
  study.phones_allowed = document.value("phones_allowed", true);
  study.id_parameters = document.value("id_parameters", study.id_parameters);
  study.person_parameter = person_parameter(document, study.id_parameters);
  study.several_entries = document.value("several_entries", study.several_entries);
  study.grace_minutes = document.value("grace_minutes", study.grace_minutes);
  const json brightness = document.value("brightness", json::object());
  study.brightness = {brightness.value("minimum_patches", 0), read_consequence(brightness)};
  const json expectations = document.value("expectations", json::object());
  study.expectations = {expectations.value("allowed_failures", 0), read_consequence(expectations)};
  const json completion = document.value("completion", json::object());
  study.completion = {read_code(completion),
                      read_code(completion.value("screened_out", json::object())),
                      read_code(completion.value("over_quota", json::object()))};
  study.quota = document.value("quota", study.quota);
}

void read_screening(const json& value, Screening& screening) {
  const std::array<std::pair<const char*, double*>, 9> members{{
      {"inverted_rho", &screening.inverted_rho},
      {"inverted_share", &screening.inverted_share},
      {"page_inverted_rho", &screening.page_inverted_rho},
      {"unreliable_rho", &screening.unreliable_rho},
      {"unreliable_tau", &screening.unreliable_tau},
      {"positional_rho", &screening.positional_rho},
      {"flat_share", &screening.flat_share},
      {"fast_seconds", &screening.fast_seconds},
      {"fast_share", &screening.fast_share},
  }};
  for (const auto& [name, target] : members) *target = value.value(name, *target);
}

Arm read_arm(const json& value, const std::string& path) {
  Arm arm;
  arm.id = value.value("id", "");
  if (value.value("widget", "shelves") == "numeric") arm.widget = Widget::numeric;
  if (value.contains("best_digit")) {
    if (arm.widget != Widget::numeric)
      throw bad_value(path + "best_digit", "only the widget `numeric` has digits");
    arm.best_digit = value.at("best_digit").get<int>();
  }
  return arm;
}

/// The ways of giving ranks: one that the study itself has, or its arms.
void read_arms(const json& document, FaultList& faults, Study& study) {
  if (!document.contains("arms")) {
    study.arms = {read_arm(document, "")};
    study.arms.front().id.clear();  // the document's id is the study's
    return;
  }
  for (const char* key : {"widget", "best_digit"})
    if (document.contains(key)) faults.add(bad_value(key, "every arm has its own"));
  const json& list = document.at("arms");
  std::set<std::string> ids;
  study.arms.clear();
  for (std::size_t i = 0; i < list.size(); ++i)
    faults.attempt([&] {
      study.arms.push_back(read_arm(list[i], indexed("arms", i) + "."));
      if (!ids.insert(study.arms.back().id).second)
        throw bad_value(indexed("arms", i) + ".id", "two arms are called so");
    });
}

void read_texts(const json& document, const TextReader& texts, Study& study) {
  study.title = texts.read(document.at("title"), "title");
  study.introduction = texts.read(document.at("introduction"), "introduction");
  study.thanks = texts.read(document.at("thanks"), "thanks");
  study.consent.version = document.at("consent").at("version").get<std::string>();
  study.consent.text = texts.read(document.at("consent").at("text"), "consent.text");
  study.question = texts.read(document.at("question"), "question");
  study.most_label = texts.read(document.at("labels").at("most"), "labels.most");
  study.least_label = texts.read(document.at("labels").at("least"), "labels.least");
  const json& difficulty = document.at("difficulty");
  study.difficulty.question = texts.read(difficulty.at("question"), "difficulty.question");
  for (std::size_t i = 0; i < difficulty.at("labels").size(); ++i) {
    study.difficulty.labels.push_back(
        texts.read(difficulty.at("labels")[i], indexed("difficulty.labels", i)));
  }
}

}  // namespace

Study parse_study(const json& document) {
  check_study_schema(document);
  Study study;
  study.document = document;
  study.document.erase("$schema");  // tells editors where the schema is, and nothing of the study
  study.id = document.at("id").get<std::string>();
  study.languages = document.at("languages").get<std::vector<std::string>>();
  FaultList faults;
  const TextReader texts(study.languages, faults);
  read_texts(document, texts, study);
  faults.attempt([&] { read_arms(document, faults, study); });
  faults.attempt([&] {
    study.picture = requests::picture_settings(document.value("picture", json::object()));
  });
  faults.attempt([&] { read_pages(document, texts, faults, study); });
  faults.attempt(
      [&] { read_demographics(document.value("demographics", json::array()), texts, study); });
  if (document.contains("minimum_window")) {
    study.minimum_window_width = document["minimum_window"].at("width").get<std::uint32_t>();
    study.minimum_window_height = document["minimum_window"].at("height").get<std::uint32_t>();
  }
  const json analysis = document.value("analysis", json::object());
  study.analysis.alpha = analysis.value("alpha", study.analysis.alpha);
  read_screening(analysis.value("screening", json::object()), study.analysis.screening);
  faults.attempt([&] { read_participation(document, study); });
  faults.throw_if_any();
  return study;
}

Study parse_study(const std::string& text) {
  json document;
  try {
    document = json::parse(text);
  } catch (const json::parse_error& error) {
    throw bad_value("", std::string("not JSON: ") + error.what());
  } catch (const json::out_of_range& error) {
    throw bad_value("", std::string("number out of range: ") + error.what());
  }
  return parse_study(document);
}

const char* widget_name(Widget widget) {
  return widget == Widget::numeric ? "numeric" : "shelves";
}

Picture reference_picture() {
  return read_picture({{"technique", "reference"}, {"label", "REF"}}, "reference");
}

std::string study_hash(const Study& study) {
  return sha256(study.document.dump());
}

}  // namespace penumbra::study
