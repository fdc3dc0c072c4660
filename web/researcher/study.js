// One study: publishing with progress, live counts, results and exports.

import { h, icon } from "/assets/shared/dom.js";
import { get, post, remove, sleep } from "/assets/shared/http.js";
import { ask } from "./dialogs.js";
import { Results } from "./results.js";
import { status_badge } from "./studies.js";
import { plain_table } from "./tables.js";
import { versions_table } from "./versions.js";
import { words_of } from "./words.js";

const poll_ms = { publishing: 700, open: 5000 };

function participant_link(study) {
  const address = new URL(`/s/${encodeURIComponent(study.id)}`, location.href).href;
  const copy = h("button", { type: "button", class: "quiet" }, icon("copy"), h("span", { role: "status" }, "Copy"));
  copy.addEventListener("click", async () => {
    await navigator.clipboard.writeText(address);
    copy.lastChild.textContent = "Copied";
  });
  const code = h("details", { class: "qr" }, h("summary", {}, "QR code"));
  code.addEventListener("toggle", () => {
    if (code.childElementCount > 1) return;
    const file = `/api/v1/studies/${encodeURIComponent(study.id)}/qr.svg`;
    code.append(h("img", { src: file, alt: `QR code of ${address}`, width: "220", height: "220" }),
      h("a", { class: "quiet", href: file, download: `${study.id}-qr.svg` }, "Save for a poster"));
  });
  return h("div", {}, h("p", { class: "link-line" }, h("span", {}, "Link for participants: "), h("a", { href: address }, address),
    navigator.clipboard ? copy : null), code);
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

/// How often each picture was answered at each position: gaps in the balance are seen here.
function cells_table({ id, cells }) {
  const slots = cells[0].answers_by_slot.map((_, slot) => String(slot + 1));
  return h("details", {}, h("summary", {}, id), plain_table(`Answers by position: ${id}`, ["Picture at position", ...slots],
    cells.map(({ picture, answers_by_slot }) => [picture, ...answers_by_slot]), { captioned: false }));
}

/// People by way of giving ranks, where there are several.
function arms_table(study) {
  if (study.arms.length === 0) return null;
  return plain_table("People by arm", ["Arm", "Entered", "Answered all pages"],
    study.arms.map(({ arm, entered, answered_all }) => [arm, entered, answered_all]));
}

function pages_table(study) {
  if (study.scenes.length === 0) return null;
  return [plain_table("Answers so far", ["Page", "Answers"], study.scenes.map(({ id, answers }) => [id, answers])),
    h("details", { class: "cells" }, h("summary", {}, "Answers by picture and position"), study.scenes.map(cells_table))];
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

class StudyView {
  constructor(study, signal) {
    Object.assign(this, { study, signal });
    this.live = h("section", { class: "card" });
    this.problem = h("p", { class: "problems", role: "alert" });
    this.results = new Results();
    this.results_problem = h("p", { class: "problems", role: "alert" });
    this.figures = figures_list(this.version_path("/figures"));
    this.element = h("div", {}, h("p", {}, h("a", { href: "#studies" }, "All studies")),
      h("h1", { tabindex: "-1" }, study.title), this.live, this.problem,
      this.results_problem, this.results.element);
    this.draw();
    this.follow();
  }

  path(rest = "") {
    return `/api/v1/studies/${encodeURIComponent(this.study.id)}${rest}`;
  }

  /// The same of the version that is shown.
  version_path(rest = "", version = this.study.version) {
    return `${this.path(rest)}?version=${version}`;
  }

  /// A button that does something at the server and shows the version that is left, after a question
  /// where `before` asks one.
  action(name, act, { main = false, before = null } = {}) {
    const button = h("button", { type: "button", class: main ? "primary" : "quiet" }, name);
    button.addEventListener("click", async () => {
      if (before && (await ask(before)) === null) return;
      button.disabled = true;
      this.problem.textContent = "";
      try {
        const changed = await act();
        if (changed) location.hash = `#study/${encodeURIComponent(changed.id)}/${changed.version}`;
        else location.hash = "#studies";
        if (changed) this.study = changed;
        this.draw();
        this.follow();
      } catch (error) {
        this.problem.textContent = words_of(error);
        button.disabled = false;
      }
    });
    return button;
  }

  close_question(version) {
    const { entered, completed } = version.participants;
    const amid = entered - completed;
    const grace = this.study.grace_minutes;
    return { title: "Close the study?", action: "Close",
      text: `Nobody can enter any more. ${amid === 1 ? "One person has" : `${amid} people have`} entered and not finished; `
        + `${grace ? `they can go on for ${grace} minutes` : "they cannot go on"}. You can open it again.` };
  }

  publish_question(draft) {
    const open = this.study.versions.find((version) => version.status === "open");
    return open ? { title: `Publish version ${draft.version}?`, action: "Publish",
      text: `Once its pictures are there, it opens and version ${open.version} closes. Those who are amid version ${open.version} can go on for a while.` } : null;
  }

  /// What can be done with a version.
  version_actions(version) {
    const { study } = this;
    const at = `${encodeURIComponent(study.id)}/${version.version}`;
    const link = (name, href, more = {}) => h("a", { class: "quiet", href, ...more }, name);
    const { status } = version;
    return [
      status === "draft" ? this.action("Render the pictures and publish", () => post(this.path("/publish")),
        { main: true, before: this.publish_question(version) }) : null,
      status === "open" ? this.action("Close the study", () => post(this.path("/close")), { before: this.close_question(version) }) : null,
      status === "closed" && !study.versions.some((other) => other.status === "open")
        ? this.action("Open again", () => post(this.version_path("/reopen", version.version))) : null,
      link("Preview", `/s/${encodeURIComponent(study.id)}?preview=${version.version}`, { target: "_blank", rel: "noopener" }),
      version.hash ? link("Participants", `#people/${at}`) : null,
      status === "publishing" ? null : link(status === "draft" ? "Edit" : "Edit as new version", `#edit/${at}`),
      link("Copy", `#copy/${at}`),
      link("Download", this.version_path("/study.json", version.version), { download: `${study.id}.json` }),
      status === "draft" ? this.action("Delete the draft", async () => {
        await remove(this.path("/draft"));
        return study.versions.length > 1 ? get(this.path()) : null;
      }, { before: { title: "Delete the draft?", text: "Its text and what was tried on it are gone for good.", action: "Delete", danger: true } }) : null,
    ];
  }

  /// Offers to measure what was shown, and tells how far that is.
  measuring() {
    const { pictures, pictures_total: total, at_work } = this.study.measures;
    if (!total || this.study.status === "publishing") return null;
    if (pictures === total) return null;
    if (at_work) return h("span", { class: "small", role: "status" }, `Measured ${pictures} of ${total} pictures`);
    return this.action("Measure the pictures", () => post(this.version_path("/measure")));
  }

  draw() {
    const { study } = this;
    const exported = (name, text) => h("a", { class: "quiet", href: this.version_path(`/${name}`), download: `${study.id}-${name}` }, text);
    this.live.replaceChildren(...[
      h("p", {}, status_badge(study.status), h("code", {}, study.id), ` version ${study.version}`,
        study.hash ? h("span", { class: "small" }, ` frozen as ${study.hash.slice(0, 12)}`) : null),
      progress_of(study),
      study.versions.some((version) => version.status === "open") ? participant_link(study) : null,
      versions_table(study, study.version, (version) => this.version_actions(version)),
      study.hash ? [h("h2", {}, `Version ${study.version}`), counts(study), arms_table(study), pages_table(study)] : null,
      study.hash ? h("div", { class: "actions" },
        h("a", { class: "quiet", href: this.version_path("/report.html"), target: "_blank", rel: "noopener" }, "Report"),
        exported("export.zip", "Everything (zip)"), exported("responses.csv", "Responses (CSV)"),
        exported("results.json", "Results (JSON)"), this.measuring()) : null,
      study.hash ? this.figures : null,
    ].flat(Infinity).filter(Boolean));
    this.draw_results();
  }

  /// Fetched again only when somebody has answered since. While pictures are rendered there are none.
  async draw_results() {
    const { study } = this;
    const stamp = JSON.stringify([study.hash, study.scenes, study.participants, study.measures.pictures]);
    // A version that is being published has its hash, and no answers yet.
    if (!study.hash || study.status === "publishing" || stamp === this.drawn) return;
    this.drawn = stamp;
    try {
      this.results.update(await get(this.version_path("/results.json")), study);
      this.results_problem.textContent = "";
    } catch (error) {
      this.drawn = null;
      this.results_problem.textContent = `The results cannot be shown: ${words_of(error)}`;
    }
  }

  async follow() {
    if (this.following) return;
    this.following = true;
    const pause_ms = () => (this.study.measures.at_work ? poll_ms.publishing : poll_ms[this.study.status]);
    while (!this.signal.aborted && pause_ms()) {
      await sleep(pause_ms());
      if (this.signal.aborted) return;
      try {
        const before = JSON.stringify(this.study);
        this.study = await get(this.version_path());
        this.problem.textContent = "";
        if (JSON.stringify(this.study) !== before) this.draw();
      } catch (error) {
        this.problem.textContent = words_of(error);
      }
    }
    this.following = false;
  }
}

export async function study_view(id, version, signal) {
  return new StudyView(await get(`/api/v1/studies/${encodeURIComponent(id)}${version ? `?version=${version}` : ""}`), signal).element;
}
