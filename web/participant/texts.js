// The study's texts in one language, by the names the pages use.

/// `welcome` is what GET /s/{study}/welcome returns.
export function texts_of(welcome, language) {
  const texts = welcome.texts[language] ?? welcome.texts[welcome.languages[0]];
  const one = (by_language) => by_language[language] ?? by_language[welcome.languages[0]];
  return {
    title: texts.title,
    introduction: texts.introduction,
    consent: texts.consent,
    thanks: texts.thanks,
    labels: { most: texts.most_label, least: texts.least_label },
    difficulty: { question: texts.difficulty_question, labels: texts.difficulty_labels },
    demographics: (welcome.demographics ?? []).map(({ id, required, question, options }) => ({
      id,
      required,
      question: one(question),
      options: options.map((option) => ({ id: option.id, text: one(option.text) })),
    })),
  };
}
