// A study small enough to render in seconds: two pages, three pictures each.

export const techniques = ["none", "shadow-map", "reference"];

export const small_study = (id, more = {}) => ({
  id,
  languages: ["en", "nl"],
  title: { en: "Shadows", nl: "Schaduwen" },
  introduction: { en: "Two pages of pictures.", nl: "Twee pagina's met plaatjes." },
  thanks: { en: "All answers are stored.", nl: "Alle antwoorden zijn bewaard." },
  consent: { version: "1", text: { en: "Taking part is voluntary.", nl: "Meedoen is vrijwillig." } },
  widget: "shelves",
  question: { en: "Order the pictures by how real their shadows look.", nl: "Zet de plaatjes op volgorde van echtheid." },
  labels: { most: { en: "most realistic", nl: "meest realistisch" }, least: { en: "least realistic", nl: "minst realistisch" } },
  difficulty: {
    question: { en: "How hard was it to see a difference?", nl: "Hoe moeilijk was het om verschil te zien?" },
    labels: ["very hard", "hard", "neither", "easy", "very easy"].map((text) => ({ en: text, nl: `${text} (nl)` })),
  },
  picture: { width: 128, height: 128, supersampling: 1, light_samples: 16 },
  techniques,
  pages: [{ scene: "half-plane" }, { scene: "boxes" }],
  completion: { code: "SHADE", url: "" },
  ...more,
});
