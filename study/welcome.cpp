#include <algorithm>

#include "study/study.h"

namespace penumbra::study {

using nlohmann::json;

json welcome_document(const Study& study) {
  json texts = json::object();
  for (const std::string& language : study.languages) {
    json difficulty_labels = json::array();
    for (const Texts& label : study.difficulty.labels) {
      difficulty_labels.push_back(label.at(language));
    }
    texts[language] = {{"title", study.title.at(language)},
                       {"introduction", study.introduction.at(language)},
                       {"consent", study.consent.text.at(language)},
                       {"question", study.question.at(language)},
                       {"most_label", study.most_label.at(language)},
                       {"least_label", study.least_label.at(language)},
                       {"difficulty_question", study.difficulty.question.at(language)},
                       {"difficulty_labels", difficulty_labels},
                       {"thanks", study.thanks.at(language)}};
  }
  json window = nullptr;
  if (study.minimum_window_width > 0) {
    window = {{"width", study.minimum_window_width}, {"height", study.minimum_window_height}};
  }
  json demographics = json::array();
  for (const Demographic& item : study.demographics) {
    json options = json::array();
    for (const Option& option : item.options) {
      options.push_back({{"id", option.id}, {"text", option.text}});
    }
    demographics.push_back({{"id", item.id},
                            {"required", item.required},
                            {"question", item.question},
                            {"options", options}});
  }
  const bool one_widget = std::all_of(study.arms.begin(), study.arms.end(), [&](const Arm& arm) {
    return arm.widget == study.arms.front().widget;
  });
  return {{"study", study.id},
          {"consent_version", study.consent.version},
          {"languages", study.languages},
          {"texts", texts},
          {"widget", one_widget ? json(widget_name(study.arms.front().widget)) : json(nullptr)},
          {"page_count", study.pages.size() + study.repeats.size() + (study.practice ? 1 : 0)},
          {"minimum_window", window},
          {"phones_allowed", study.phones_allowed},
          {"id_parameters", study.id_parameters},
          {"minimum_patches", study.brightness.minimum_patches},
          {"demographics", demographics}};
}

}  // namespace penumbra::study
