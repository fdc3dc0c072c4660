// The study's texts as the server sends them for one language, by the names the pages use.

/// `texts` of the welcome or of an enrolment.
export function texts_of(texts) {
  return {
    title: texts.title,
    introduction: texts.introduction ?? "",
    consent: texts.consent ?? "",
    labels: { most: texts.best_label, least: texts.worst_label },
    difficulty: texts.difficulty,
    demographics: texts.demographics ?? [],
  };
}
