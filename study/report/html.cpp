#include "study/report/html.h"

#include <algorithm>
#include <set>

#include "figures/text.h"
#include "study/report/scripts.h"
#include "study/report/words.h"
#include "study/study.h"

namespace penumbra::study {

namespace {

using figures::escaped;
using nlohmann::json;
using report::decimal;
using report::interval;
using report::number;
using report::probability;

std::string element(const char* tag, const std::string& inside,
                    const std::string& attributes = "") {
  return std::string("<") + tag + attributes + ">" + inside + "</" + tag + ">\n";
}

std::string paragraph(const std::string& text) {
  return element("p", escaped(text));
}

std::string cell(const std::string& text) {
  return "<td>" + escaped(text) + "</td>";
}

std::string text_cell(const std::string& text) {
  return "<td class=\"text\">" + escaped(text) + "</td>";
}

std::string row_head(const std::string& text) {
  return "<th scope=\"row\">" + escaped(text) + "</th>";
}

/// A table that can be scrolled where it is too wide; names of columns that begin with a blank hold
/// text.
std::string table(const std::string& caption, const std::vector<std::string>& columns,
                  const std::string& rows) {
  std::string head;
  for (const auto& name : columns) {
    const bool is_text = name.starts_with(' ');
    head += std::string("<th scope=\"col\"") + (is_text ? " class=\"text\"" : "") + ">" +
            escaped(is_text ? name.substr(1) : name) + "</th>";
  }
  return "<div class=\"table\" tabindex=\"0\"><table><caption>" + escaped(caption) +
         "</caption>\n<thead><tr>" + head + "</tr></thead>\n<tbody>\n" + rows +
         "</tbody></table></div>\n";
}

class ReportWriter {
 public:
  ReportWriter(const json& document_, const ReportContext& context_)
      : document(document_), context(context_), names(context_.figures.labels) {
    alpha = document.at("methods").value("alpha", 0.05);
    figures = figures_of(document, context.figures);
  }

  std::string run() const {
    const std::string title = context.study != nullptr
                                  ? text_of(context.study->title)
                                  : document.value("study", std::string("Ranking survey"));
    std::string css;
    for (const EmbeddedFile& file : report_files())
      if (file.path.ends_with("report.css")) css = file.text;
    return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
           escaped(title) + "</title>\n<style>\n" + css + "</style>\n</head>\n<body>\n<main>\n" +
           element("h1", escaped(title)) + identity() + warnings() + asked() + people() + arms() +
           results() + sets() + pairs() + methods() + "</main>\n</body>\n</html>\n";
  }

 private:
  std::string text_of(const Texts& texts) const {
    return texts.at(context.study->languages.front());
  }

  std::string identity() const {
    std::string text;
    if (document.contains("study"))
      text += "Study " + element_code(document["study"].get<std::string>()) + ". ";
    if (document.contains("study_hash"))
      text += "Frozen as " + element_code(document["study_hash"].get<std::string>()) + ". ";
    return text.empty() ? "" : element("p", text, " class=\"soft\"");
  }

  static std::string element_code(const std::string& text) {
    return "<code>" + escaped(text) + "</code>";
  }

  std::string warnings() const {
    std::string items;
    for (const auto& warning : report::warnings(document)) items += element("li", escaped(warning));
    if (items.empty()) return "";
    return element("h2", "Before you read on") + element("ul", items, " class=\"warnings\"");
  }

  std::string asked() const {
    std::string text = element("h2", "What was asked");
    const json& set = document.at("included_sets").at("all");
    if (context.study != nullptr) {
      const Study& study = *context.study;
      text += paragraph(std::string("“") + text_of(study.question) + "” Pictures were " +
                        ways_of_ranking(study) + " from “" + text_of(study.most_label) +
                        "” (rank 1) to “" + text_of(study.least_label) +
                        "”; pictures could share a place.");
      text += paragraph("About every page: “" + text_of(study.difficulty.question) + "” from 1 (“" +
                        text_of(study.difficulty.labels.front()) + "”) to 5 (“" +
                        text_of(study.difficulty.labels.back()) +
                        "”), which is the page's weight in weighted means.");
      std::string rows;
      for (const Page& page : study.pages) {
        std::string pictures;
        for (const Picture& picture : page.pictures)
          pictures += (pictures.empty() ? "" : ", ") + picture.label;
        rows +=
            "<tr>" + row_head(page.id) + text_cell(page.scene) + text_cell(pictures) + "</tr>\n";
      }
      text += table("Pages", {" page", " scene", " pictures"}, rows);
      if (!study.repeats.empty())
        text += paragraph(std::to_string(study.repeats.size()) +
                          " pages were shown a second time; that measures reliability only.");
    } else {
      text += paragraph("Pictures of " + std::to_string(set.at("scenes").size()) +
                        " pages were put in order; rank 1 is most realistic, and pictures could "
                        "share a place. The study's document was not part of the data.");
    }
    return text;
  }

  static std::string ways_of_ranking(const Study& study) {
    std::set<std::string> ways;
    for (const Arm& arm : study.arms)
      ways.insert(arm.widget == Widget::numeric ? "given digits" : "put on shelves");
    std::string text;
    for (const auto& way : ways) text += (text.empty() ? "" : " or ") + way;
    return text;
  }

  std::string people() const {
    std::string text = element("h2", "Who took part");
    std::string items;
    const auto add = [&](const std::string& name, const std::string& value) {
      items += element("dt", escaped(name)) + element("dd", escaped(value));
    };
    if (context.attendance) {
      const Attendance& who = *context.attendance;
      add("entered", std::to_string(who.entered));
      add("finished", std::to_string(who.completed));
      add("stopped early or still at it",
          std::to_string(who.entered - std::min(who.entered, who.completed)) +
              "; the pages they answered are inside the results");
      add("withdrew", std::to_string(who.withdrawn) + "; all they gave was deleted");
    } else if (document.contains("counts")) {
      const json& counts = document["counts"];
      add("entered", std::to_string(counts.value("entered", 0)));
      add("answered every page", std::to_string(counts.value("completed", 0)));
      add("stopped early", std::to_string(counts.value("stopped_early", 0)));
    }
    add("in the analysis", document.at("participants").dump() + " people, " +
                               document.at("pages").dump() + " answered pages");
    text += element("dl", items) + exclusions() + flags();
    return text;
  }

  std::string exclusions() const {
    if (!context.attendance) return "";
    if (context.attendance->excluded.empty()) return paragraph("No participant was taken out.");
    std::string rows;
    for (const auto& who : context.attendance->excluded)
      rows += "<tr>" + row_head(who.participant) + text_cell(who.reason) + "</tr>\n";
    return table("Taken out by a researcher, and nowhere in the results",
                 {" participant", " reason"}, rows);
  }

  std::string flags() const {
    std::map<std::string, std::set<std::string>> people_by_flag;
    std::string rows;
    for (const json& flag : document.at("flags")) {
      people_by_flag[flag.at("flag")].insert(flag.at("participant").get<std::string>());
      rows += "<tr>" + row_head(flag.at("participant")) + text_cell(flag.at("flag")) +
              cell(decimal(number(flag, "value"), 2)) +
              cell(decimal(number(flag, "threshold"), 2)) + text_cell(flag.value("reason", "")) +
              "</tr>\n";
    }
    if (rows.empty()) return paragraph("No participant has a flag.");
    std::string counts;
    for (const auto& [name, people] : people_by_flag)
      counts += (counts.empty() ? "" : ", ") + std::to_string(people.size()) + " " + name;
    return paragraph("Flags are reasons to look again and change nothing by themselves: " + counts +
                     ".") +
           table("Flags", {" participant", " flag", "value", "threshold", " reason"}, rows);
  }

  /// What each way of giving ranks did to people, where there are several.
  std::string arms() const {
    if (!document.contains("arms")) return "";
    const json& found = document.at("arms");
    std::string rows;
    for (const json& arm : found.at("list"))
      rows += "<tr>" + row_head(arm.at("arm")) + cell(arm.at("participants").dump()) +
              cell(arm.at("inverted").dump()) + cell(decimal(number(arm, "read_right"), 3)) +
              cell(interval(arm, "ci95", 3)) + cell(decimal(number(arm, "mean_rho"), 2)) +
              "</tr>\n";
    std::string pairs;
    for (const json& pair : found.at("comparisons"))
      pairs += "<tr>" + row_head(pair.at("a")) + text_cell(pair.at("b")) +
               cell(decimal(number(pair, "difference"), 3)) +
               cell(probability(number(pair, "p_value"))) +
               cell(probability(number(pair, "p_holm"))) + "</tr>\n";
    return element("h2", "Ways of giving ranks") +
           paragraph(
               "People were assigned to one of them at random. Who is not flagged as inverted read "
               "the scale right; agreement is the mean rank correlation with everybody else.") +
           table(
               "Arms",
               {" arm", "people", "inverted", "share that read right", "95% interval", "agreement"},
               rows) +
           table("Differences of these shares, Fisher's exact test",
                 {" arm", " other arm", "difference", "p", "p (Holm)"}, pairs);
  }

  std::string figure(const std::string& kind, const std::string& scene) const {
    for (const Figure& item : figures) {
      if (item.scene != scene || !item.name.starts_with(kind)) continue;
      return element("figure", item.svg + element("figcaption", escaped(item.title + ".")));
    }
    return "";
  }

  std::string means(const json& part) const {
    std::string rows;
    const json letters = part.value("letters", json::object());
    for (const json& row : part.at("techniques")) {
      const std::string id = row.at("technique");
      rows += "<tr>" + row_head(names(id)) + cell(std::to_string(row.value("n", 0))) +
              cell(decimal(number(row, "mean_rank"), 2)) + cell(interval(row, "ci95", 2)) +
              cell(decimal(number(row, "sd"), 2)) + cell(decimal(number(row, "median"), 1)) +
              cell(decimal(number(row, "weighted_mean_rank"), 2)) +
              text_cell(letters.value(id, "")) + "</tr>\n";
    }
    return table("Techniques that share a letter do not differ (paired t, Bonferroni)",
                 {" technique", "n", "mean rank", "95% interval", "s.d.", "median", "weighted mean",
                  " letters"},
                 rows);
  }

  std::string words(const json& part) const {
    std::string text;
    for (const auto& sentence : report::sentences(part, names, alpha)) text += paragraph(sentence);
    return text;
  }

  std::string part_section(const json& part, const std::string& scene) const {
    std::string text = element("h3", escaped(scene.empty() ? "All scenes" : scene));
    text += words(part);
    if (part.value("pages", 0) == 0) return text;
    text += means(part);
    text +=
        element("div", figure("mean-ranks", scene) + figure("worths", scene), " class=\"figures\"");
    if (scene.empty()) text += figure("critical-difference", scene) + figure("histograms", scene);
    return text;
  }

  std::string results() const {
    const json& set = document.at("included_sets").at("all");
    std::string text = element("h2", "Results");
    text += element("p",
                    "Everybody who was not taken out. Participants are the units: a person counts "
                    "once, also where several pages are pooled.",
                    " class=\"soft\"");
    text += part_section(set.at("overall"), "");
    for (const Figure& item : figures)
      if (item.scene.empty() &&
          (item.name.starts_with("perceived-by") || item.name.starts_with("pareto")))
        text += element("figure", item.svg + element("figcaption", escaped(item.title + ".")));
    if (set.at("scenes").size() > 1)
      for (const json& part : set.at("scenes")) text += part_section(part, part.at("scene"));
    return text;
  }

  /// The same means for the three sets of participants, so that a reader sees what flags change.
  std::string sets() const {
    const json& included = document.at("included_sets");
    std::vector<std::string> columns{" technique"};
    std::string meanings;
    for (const auto& set : report::set_names()) {
      if (!included.contains(set.id)) continue;
      const json& overall = included.at(set.id).at("overall");
      columns.push_back(set.title + " (n " + std::to_string(overall.value("participants", 0)) +
                        ")");
      meanings += (meanings.empty() ? "" : " ") + set.title + ": " + set.meaning + ".";
    }
    std::string rows;
    for (const json& row : included.at("all").at("overall").at("techniques")) {
      rows += "<tr>" + row_head(names(row.at("technique")));
      for (const auto& set : report::set_names()) {
        if (!included.contains(set.id)) continue;
        std::string value = "–";
        for (const json& other : included.at(set.id).at("overall").at("techniques"))
          if (other.at("technique") == row.at("technique"))
            value = decimal(number(other, "mean_rank"), 2);
        rows += cell(value);
      }
      rows += "</tr>\n";
    }
    return element("h2", "What flags would change") + paragraph(meanings) +
           table("Mean ranks, all scenes", columns, rows);
  }

  std::string pair_rows(const json& part) const {
    const json nothing = json::object();
    const auto of = [&](const char* test, const json& pair) -> const json& {
      const json* found = report::pair_of(part.at(test), pair.at("a"), pair.at("b"));
      return found != nullptr ? *found : nothing;
    };
    std::string rows;
    for (const json& test : part.at("paired_t")) {
      const json& wilcoxon = of("wilcoxon", test);
      const json& sign = of("sign", test);
      rows += "<tr>" + row_head(names(test.at("a"))) + text_cell(names(test.at("b"))) +
              cell(std::to_string(test.value("n", 0))) +
              cell(decimal(number(test, "mean_difference"), 2)) +
              cell(decimal(number(test, "t"), 2)) + cell(std::to_string(test.value("df", 0))) +
              cell(probability(number(test, "p_bonferroni"))) +
              cell(decimal(number(wilcoxon, "statistic_v"), 1)) +
              cell(probability(number(wilcoxon, "p_holm"))) +
              cell(decimal(number(sign, "probability_a_better"), 2)) +
              cell(interval(sign, "ci95", 2)) + "</tr>\n";
    }
    return rows;
  }

  std::string pairs() const {
    const json& set = document.at("included_sets").at("all");
    std::string text = element("h2", "All pairs");
    text += paragraph(
        "Differences of mean ranks (negative: the first is more realistic); paired t with p after "
        "Bonferroni; Wilcoxon's signed ranks V with p after Holm; P, the probability that the "
        "first "
        "is put before the second, ties half, with its 95% interval. A family is all pairs of one "
        "table.");
    const std::vector<std::string> columns{" first",       " second",   "n", "difference", "t",
                                           "df",           "p (Bonf.)", "V", "p (Holm)",   "P",
                                           "interval of P"};
    const auto add = [&](const json& part, const std::string& name) {
      const std::size_t family = part.at("paired_t").size();
      if (family == 0) return;
      text += table(name + ", family of " + std::to_string(family), columns, pair_rows(part));
    };
    add(set.at("overall"), "All scenes");
    if (set.at("scenes").size() > 1)
      for (const json& part : set.at("scenes")) add(part, part.at("scene"));
    return text;
  }

  std::string methods() const {
    std::string items;
    for (const auto& [name, value] : document.at("methods").items()) {
      std::string spaced = name;
      std::replace(spaced.begin(), spaced.end(), '_', ' ');
      items += element("dt", escaped(spaced)) +
               element("dd", escaped(value.is_string() ? value.get<std::string>() : value.dump()));
    }
    items += element("dt", "program") + element("dd", "Penumbra " PENUMBRA_VERSION);
    if (document.contains("data_sha256"))
      items += element("dt", "data, SHA-256") +
               element("dd", element_code(document["data_sha256"].get<std::string>()));
    return element("h2", "Methods and versions") + element("dl", items, " class=\"notes\"");
  }

  const json& document;
  const ReportContext& context;
  report::Names names;
  double alpha = 0.05;
  std::vector<Figure> figures;
};

}  // namespace

std::string html_report(const json& report, const ReportContext& context) {
  return ReportWriter(report, context).run();
}

}  // namespace penumbra::study
