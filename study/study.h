#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

/// Surveys: what is shown to whom, what an answer is, and what it means. Pure functions, no I/O.
namespace penumbra::study {

/// A text by language ("en" -> "..."). Every text of a study has all of the study's languages.
using Texts = std::map<std::string, std::string>;

/// How participants give their ranks: pictures on shelves, or typed digits as in 2007.
enum class Widget { shelves, numeric };

/// "shelves" or "numeric".
const char* widget_name(Widget widget);

/// A way of giving ranks. A study has one, or several to which people are assigned at random.
struct Arm {
  std::string id;  ///< empty where the study has one way only
  Widget widget = Widget::shelves;
  int best_digit = 1;  ///< of `numeric`: the digit, 1 or 9, of what is most realistic
};

/// A typed digit, counted from 1 for the most realistic.
constexpr int digit_from_best(int digit, int best_digit) {
  return best_digit == 1 ? digit : 10 - digit;
}

/// Where the converged picture of a page appears: nowhere, among the pictures to rank and unmarked,
/// beside them and marked, or both.
enum class ReferenceUse { none, hidden, shown, both };

/// A picture to rank: rendered, or one of the researcher's own.
struct Picture {
  std::string id;         ///< name in exports, unique on its page; the technique's unless given
  std::string technique;  ///< technique or preset, as the render service resolves it
  std::string own;        ///< instead of a technique: SHA-256 of a picture that was uploaded
  nlohmann::json parameters = nlohmann::json::object();  ///< override the preset's
  std::string label;            ///< abbreviation in tables, the id unless given
  std::string parameters_hash;  ///< of the parameters' canonical text
};

/// What an attentive person says on a page: one picture before another (a gold item), or all on
/// one place, because the page's question asks for that (an attention item, which ranks nothing and
/// is counted nowhere).
struct Expectation {
  bool all_same = false;
  std::string better;  ///< ids of pictures; empty with `all_same`
  std::string worse;
};

/// A camera that turns about a point, the y axis up: people see each picture of a page from several
/// sides, whichever they choose.
struct Orbit {
  std::array<double, 3> centre{};  ///< looked at; metres
  double distance = 1.0;           ///< of the camera from it; metres
  double elevation = 20.0;         ///< of the camera above it; degrees
  double from = -30.0;             ///< degrees from the z axis towards the x axis
  double to = 30.0;                ///< degrees; the views are at equal steps, both ends included
  int frames = 9;
};

/// One page: pictures of one scene.
struct Page {
  std::string id;  ///< unique; the scene's id unless given
  std::string scene;
  std::string camera;          ///< empty: the scene's first
  std::optional<Orbit> orbit;  ///< where the camera turns; what else it has is `camera`'s
  ReferenceUse reference = ReferenceUse::none;
  std::vector<Picture> pictures;  ///< to rank, the hidden reference included, in the file's order
  std::optional<Expectation> expected;
  Texts question;  ///< empty: the study's

  bool counted() const { return !expected || !expected->all_same; }
};

/// A page with a known answer, shown first and never counted.
struct Practice {
  Page page;  ///< its pictures are in the order of the right answer,
              ///< most realistic first
};

struct Consent {
  std::string version;
  Texts text;
};

/// "How hard is it to see a difference": five steps, index 0 is answer 1 (hard to see).
struct Difficulty {
  Texts question;
  std::vector<Texts> labels;  ///< five
};

struct Option {
  std::string id;
  Texts text;
};

/// A question about the participant, asked once.
struct Demographic {
  std::string id;
  Texts question;
  std::vector<Option> options;
  bool required = false;
};

/// Thresholds of the flags (never silent changes); defaults as in docs of the study format.
struct Screening {
  double inverted_rho = -0.5;       ///< mean leave-one-out rho at or below: scale read backwards
  double inverted_share = 0.8;      ///< ... and negative on at least this share of pages
  double page_inverted_rho = -0.7;  ///< one page at or below, of an otherwise positive person
  double unreliable_rho = 0.2;      ///< mean rho below
  double unreliable_tau = 0.3;      ///< tau-b between the showings of a repeated page below
  double positional_rho = 0.7;      ///< mean rho of rank and slot at or beyond, either way
  double flat_share = 0.5;          ///< all equal on more than this share of pages
  double fast_seconds = 2.0;        ///< active seconds per picture below
  double fast_share = 0.5;          ///< ... or below this share of the median participant
};

/// Frozen with the study, so that the analysis is chosen before the answers are seen.
struct AnalysisPlan {
  double alpha = 0.05;
  Screening screening;
};

struct CompletionCode {
  std::string code;
  std::string url;  ///< may be empty
};

/// Panels pay by code: one for each way in which taking part can end.
struct Completion {
  CompletionCode complete;      ///< shown after the last page is committed
  CompletionCode screened_out;  ///< where a check ends the study for a person
  CompletionCode over_quota;    ///< where the study has as many people as it needs
};

/// What follows where a person fails a check: a flag, or that the study is over for them.
enum class Consequence { flag, screen_out };

/// Dark patches shown before the first page.
inline constexpr int dark_patches = 8;

/// How many of them a person must tell apart.
struct BrightnessCheck {
  int minimum_patches = 0;  ///< 0: no check
  Consequence consequence = Consequence::flag;
};

/// How failed attention and gold items are taken.
struct ExpectationRule {
  int allowed_failures = 0;
  Consequence consequence = Consequence::flag;
};

struct Study {
  std::string id;
  std::vector<std::string> languages;  ///< the first is the default
  Texts title;
  Texts introduction;
  Texts thanks;
  Consent consent;
  std::vector<Arm> arms{1};  ///< at least one
  Texts question;
  Texts most_label;   ///< most realistic end
  Texts least_label;  ///< least realistic end
  Difficulty difficulty;
  /// Of all pictures, by the names of a request's fields (requests/fields.h): width, height, ...
  nlohmann::json picture;
  std::optional<Practice> practice;
  std::vector<Page> pages;
  std::vector<std::size_t> repeats;  ///< indices of pages that are shown a second time, at the end
  std::vector<Demographic> demographics;
  std::uint32_t minimum_window_width = 0;   ///< CSS pixels
  std::uint32_t minimum_window_height = 0;  ///< CSS pixels
  bool phones_allowed = true;
  AnalysisPlan analysis;
  std::vector<std::string> id_parameters;  ///< of the page's address, kept with the participant
  std::string person_parameter;  ///< of them, the one that names a person; empty: none does
  bool several_entries = false;  ///< whether a person may enter more than once
  int grace_minutes = 120;       ///< after closing, for those who are amid the study
  BrightnessCheck brightness;
  ExpectationRule expectations;
  Completion completion;
  std::uint32_t quota = 0;  ///< completed participants after which no one enters; 0: no limit
  nlohmann::json document;  ///< what was parsed
};

/// Parses and checks a study document (schema/study.schema.json, then what a schema cannot say).
/// Throws bad_value whose field is the path of what is wrong, e.g. `pages[2].techniques[0]`.
Study parse_study(const nlohmann::json& document);

/// The same from text; throws bad_value naming line and column where it is no JSON.
Study parse_study(const std::string& text);

/// SHA-256 of the canonical document (keys sorted, no blanks), 64 hexadecimal digits: two files
/// with the same meaning but other blanks or key order have the same hash.
std::string study_hash(const Study& study);

/// The reference as a picture of a page.
Picture reference_picture();

/// Bodies of POST /api/v1/renders for one page: pictures[i][f] is view f of picture i in the page's
/// order, and the reference where the page shows it. A page whose camera does not turn has one
/// view. One's own picture is {"picture": its SHA-256} instead.
struct PageRenders {
  std::vector<std::vector<nlohmann::json>> pictures;
  std::vector<nlohmann::json> shown_reference;  ///< empty where the page shows none
};
PageRenders page_renders(const Study& study, const Page& page);

/// The view in which a page is first seen: the middle one.
std::size_t first_view(const Page& page);

/// The SHA-256 of one's own picture; empty where the request is a render's.
std::string own_picture(const nlohmann::json& request);

/// Whether a text can be the name of a picture that was uploaded: a SHA-256 in hexadecimal digits.
bool is_picture_name(const std::string& text);

/// Every distinct render body that the study needs, practice page included, in order of pages.
std::vector<nlohmann::json> all_renders(const Study& study);

/// What the participant's page may know before anybody has agreed: {"study", "consent_version",
/// "languages", "texts": {language: {"title", "introduction", "consent", "question", "most_label",
/// "least_label", "difficulty_question", "difficulty_labels": [5], "thanks"}}, "widget" (null where
/// people get different ones), "page_count", "minimum_window": {"width", "height"} | null,
/// "phones_allowed", "id_parameters", "minimum_patches", "demographics": [{"id", "required",
/// "question": {language: text}, "options":
/// [{"id", "text"}]}]}. Nothing in it tells techniques, scenes, thresholds or the completion code.
nlohmann::json welcome_document(const Study& study);

/// JSON Schema of study documents: schema/study.schema.json, the keys of `picture` as requests have
/// them.
const nlohmann::json& study_schema();

}  // namespace penumbra::study
