// One study: publishing with progress, live counts, results and exports.

import { h, icon } from "/assets/shared/dom.js";
import { get, post, sleep } from "/assets/shared/http.js";
import { Results } from "./results.js";
import { status_badge } from "./studies.js";
import { words_of } from "./words.js";

const poll_ms = { publishing: 700, open: 5000 };

function participant_link(study) {
  const address = new URL(`/s/${encodeURIComponent(study.id)}`, location.href).href;
  const copy = h("button", { type: "button", class: "quiet" }, icon("copy"), h("span", { role: "status" }, "Copy"));
  copy.addEventListener("click", async () => {
    await navigator.clipboard.writeText(address);
    copy.lastChild.textContent = "Copied";
  });
  return h("p", { class: "link-line" }, h("span", {}, "Link for participants: "), h("a", { href: address }, address),
    navigator.clipboard ? copy : null);
}

function counts(study) {
  const { entered, completed, withdrawn, tests } = study.participants;
  const figure = (number, name) => h("div", {}, h("dd", {}, String(number)), h("dt", {}, name));
  return h("dl", { class: "figures" }, figure(completed, "completed"), figure(entered, "entered"),
    figure(withdrawn, "withdrawn"), tests ? figure(tests, "previews, not counted") : null);
}

/// Links to the figures, asked for when first opened: the server computes the results for them.
function figures_list(path) {
  const list = h("ul", { class: "small" });
  const details = h("details", { class: "figure-list" }, h("summary", {}, "Figures for print (SVG)"), list);
  details.addEventListener("toggle", async () => {
    if (!details.open || list.childElementCount) return;
    list.replaceChildren(h("li", { role: "status" }, "Drawing…"));
    try {
      const { figures } = await get(path);
      list.replaceChildren(...figures.map(({ name, title, url }) => h("li", {}, h("a", { href: url, download: `${name}.svg` }, title))));
    } catch (error) {
      list.replaceChildren();
      details.open = false;
      details.after(h("p", { class: "problems", role: "alert" }, words_of(error)));
    }
  });
  return details;
}

function pages_table(study) {
  if (study.scenes.length === 0) return null;
  return h("table", { class: "plain" }, h("caption", {}, "Answers so far"),
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Page"), h("th", { scope: "col" }, "Answers"))),
    h("tbody", {}, study.scenes.map(({ scene, answers }) => h("tr", {}, h("th", { scope: "row" }, scene),
      h("td", { class: "number" }, String(answers))))));
}

function progress_of(study) {
  const { pictures, pictures_total, error } = study.progress;
  return [
    study.status === "publishing" ? h("div", { class: "publishing" },
      h("label", { for: "publishing" }, `Rendering the pictures: ${pictures} of ${pictures_total}`),
      h("progress", { id: "publishing", max: String(Math.max(1, pictures_total)), value: String(pictures) })) : null,
    error ? h("p", { class: "problems", role: "alert" }, `Publishing failed: ${error.message ?? error}`) : null,
  ];
}

/// True once people were let in: before that there is nothing to count or to export.
const has_opened = ({ status }) => status === "open" || status === "closed";

class StudyView {
  constructor(study, signal) {
    Object.assign(this, { study, signal });
    this.live = h("section", { class: "card" });
    this.problem = h("p", { class: "problems", role: "alert" });
    this.results = new Results();
    this.results_problem = h("p", { class: "problems", role: "alert" });
    this.figures = figures_list(this.path("/figures"));
    this.element = h("div", {}, h("p", {}, h("a", { href: "#studies" }, "All studies")),
      h("h1", { tabindex: "-1" }, study.title), this.live, this.problem,
      this.results_problem, this.results.element);
    this.draw();
    this.follow();
  }

  path(rest = "") {
    return `/api/v1/studies/${encodeURIComponent(this.study.id)}${rest}`;
  }

  action(name, path, main) {
    const button = h("button", { type: "button", class: main ? "primary" : "quiet" }, name);
    button.addEventListener("click", async () => {
      button.disabled = true;
      this.problem.textContent = "";
      try {
        this.study = await post(this.path(path));
        this.draw();
        this.follow();
      } catch (error) {
        this.problem.textContent = words_of(error);
        button.disabled = false;
      }
    });
    return button;
  }

  draw() {
    const { study } = this;
    const exported = (name, text) => h("a", { class: "quiet", href: this.path(`/${name}`), download: `${study.id}-${name}` }, text);
    this.live.replaceChildren(...[
      h("p", {}, status_badge(study.status), h("code", {}, study.id), ` version ${study.version}`,
        study.hash ? h("span", { class: "small" }, ` frozen as ${study.hash.slice(0, 12)}`) : null),
      progress_of(study),
      study.status === "open" ? participant_link(study) : null,
      has_opened(study) ? [counts(study), pages_table(study)] : null,
      h("div", { class: "actions" },
        study.status === "draft" ? this.action("Render the pictures and publish", "/publish", true) : null,
        study.status === "open" ? this.action("Close the study", "/close", false) : null,
        has_opened(study) ? [h("a", { class: "quiet", href: this.path("/report.html"), target: "_blank", rel: "noopener" }, "Report"),
          exported("export.zip", "Everything (zip)"), exported("responses.csv", "Responses (CSV)"),
          exported("results.json", "Results (JSON)")] : null),
      has_opened(study) ? this.figures : null,
    ].flat(Infinity).filter(Boolean));
    this.draw_results();
  }

  /// Fetched again only when somebody has answered since. While pictures are rendered there are none.
  async draw_results() {
    const { study } = this;
    const stamp = JSON.stringify([study.hash, study.scenes, study.participants]);
    if (!has_opened(study) || stamp === this.drawn) return;
    this.drawn = stamp;
    try {
      this.results.update(await get(this.path("/results.json")), study);
      this.results_problem.textContent = "";
    } catch (error) {
      this.drawn = null;
      this.results_problem.textContent = `The results cannot be shown: ${words_of(error)}`;
    }
  }

  async follow() {
    if (this.following) return;
    this.following = true;
    while (!this.signal.aborted && poll_ms[this.study.status]) {
      await sleep(poll_ms[this.study.status]);
      if (this.signal.aborted) return;
      try {
        const before = JSON.stringify(this.study);
        this.study = await get(this.path());
        this.problem.textContent = "";
        if (JSON.stringify(this.study) !== before) this.draw();
      } catch (error) {
        this.problem.textContent = words_of(error);
      }
    }
    this.following = false;
  }
}

export async function study_view(id, signal) {
  return new StudyView(await get(`/api/v1/studies/${encodeURIComponent(id)}`), signal).element;
}
