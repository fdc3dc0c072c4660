// Mean ranks per scene and overall: in the columns of their subsets, as van Sambeek 2007 prints them
// (tables 4.3 to 4.9), and with their 95% intervals.

import { h, s } from "/assets/shared/dom.js";
import { plain_table } from "./tables.js";
import { fixed, probability, significant } from "./words.js";

const sets = {
  all: "Everybody",
  without_flagged: "Without flagged participants",
  inverted_turned: "Inverted participants turned round",
};

/// Label of a picture id as the study file has it.
function labels_of(study) {
  const labels = new Map();
  const lists = [study.document.techniques, ...study.document.pages.map((page) => page.techniques)];
  for (const item of lists.filter(Boolean).flat()) {
    if (typeof item === "object") labels.set(item.id ?? item.technique, item.label ?? item.id ?? item.technique);
  }
  return (id) => labels.get(id) ?? id;
}

const mean_of = (technique) => technique.weighted_mean_rank ?? technique.mean_rank;

function subset_table(part, label, alpha) {
  const { techniques } = part;
  const subsets = part.subsets ?? [];
  return h("table", { class: "subsets" },
    h("thead", {},
      subsets.length ? h("tr", {}, h("td", {}), h("th", { scope: "colgroup", colspan: String(subsets.length) }, "subset for α = ", String(alpha))) : null,
      h("tr", {}, h("th", { scope: "col" }, "Technique"),
        subsets.length ? subsets.map((_, index) => h("th", { scope: "col" }, String(index + 1)))
          : h("th", { scope: "col" }, "mean rank"))),
    h("tbody", {}, techniques.map((technique) => h("tr", {}, h("th", { scope: "row" }, label(technique.technique)),
      (subsets.length ? subsets : [[technique.technique]]).map((subset) => h("td", { class: "number" },
        subset.includes(technique.technique) ? fixed(mean_of(technique), 2) : ""))))));
}

const letter_px = 12;  // of a bold letter in the figure, generously

/// Means as points and 95% intervals as bars over ranks 1 (most realistic) to the number of techniques.
function interval_figure(part, label) {
  const { techniques } = part;
  const longest = Math.max(...techniques.map(({ technique }) => label(technique).length));
  const [row, left, right, top] = [30, 14 + letter_px * longest, 24, 14];
  const width = left + 450;
  const height = top + row * techniques.length + 40;
  const highest = Math.max(2, techniques.length);
  const x = (rank) => left + ((rank - 1) / (highest - 1)) * (width - left - right);
  const axis = top + row * techniques.length;
  const ticks = Array.from({ length: highest }, (_, index) => index + 1);
  const description = techniques.map((technique) => `${label(technique.technique)} ${fixed(mean_of(technique), 2)}`).join(", ");
  return h("figure", {}, s("svg", { class: "intervals", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `Mean ranks: ${description}` },
    ticks.map((rank) => [
      s("line", { class: "grid", x1: x(rank), x2: x(rank), y1: top, y2: axis }),
      s("text", { class: "tick", x: x(rank), y: axis + 18 }, String(rank)),
    ]),
    s("text", { class: "end start", x: x(1), y: axis + 35 }, "most realistic"),
    s("text", { class: "end", x: x(highest), y: axis + 35 }, "least realistic"),
    techniques.map((technique, index) => {
      const y = top + row * (index + 0.5);
      const [low, high] = technique.ci95 ?? [NaN, NaN];
      return [
        s("text", { class: "name", x: left - 14, y: y + 5 }, label(technique.technique)),
        Number.isFinite(low) && Number.isFinite(high)
          ? s("line", { class: "bar", x1: x(Math.max(1, low)), x2: x(Math.min(highest, high)), y1: y, y2: y }) : null,
        Number.isFinite(technique.mean_rank) ? s("circle", { class: "mean", cx: x(technique.mean_rank), cy: y, r: 5 }) : null,
      ];
    })), h("figcaption", { class: "small" }, "Mean ranks with 95% intervals"));
}

function test_line(part) {
  const lines = [];
  const { friedman, quade } = part;
  if (Number.isFinite(friedman?.chi_square)) {
    lines.push(`Friedman χ² = ${significant(friedman.chi_square, 4)}, df = ${friedman.df}, p = ${probability(friedman.p_value)}, Kendall's W = ${fixed(friedman.kendalls_w, 3)}.`);
  }
  if (Number.isFinite(quade?.f)) lines.push(`Quade F = ${significant(quade.f, 4)}, p = ${probability(quade.p_value)}.`);
  return lines.length ? h("p", { class: "small" }, lines.join(" ")) : null;
}

function part_section(name, part, label, alpha) {
  return h("section", { class: "card result" }, h("h3", {}, name),
    h("p", { class: "small" }, `${part.participants} participant${part.participants === 1 ? "" : "s"}`),
    h("div", { class: "pair" }, h("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": `Table: ${name}` },
      subset_table(part, label, alpha)), interval_figure(part, label)),
    test_line(part), part.reason ? h("p", { class: "small" }, part.reason) : null);
}

/// What each way of giving ranks did to people, where there are several.
function arms_section(arms) {
  if (!arms) return null;
  const share = (value) => `${fixed(100 * value, 0)}%`;
  return h("section", { class: "card result" }, h("h3", {}, "Ways of giving ranks"),
    h("p", { class: "small" }, "Who is not flagged as inverted read the scale right. Agreement is a person's rank correlation with everybody else, all arms taken together."),
    plain_table("Arms", ["Arm", "People", "Inverted", "Read right", "95% interval", "Agreement"], arms.list.map((arm) =>
      [arm.arm, arm.participants, arm.inverted, share(arm.read_right), arm.ci95.map(share).join(" to "), fixed(arm.mean_rho, 2)])),
    plain_table("Differences (Fisher's exact test)", ["Arms", "Difference", "p", "p (Holm)"], arms.comparisons.map((pair) =>
      [`${pair.a} − ${pair.b}`, `${fixed(100 * pair.difference, 0)} points`, probability(pair.p_value), probability(pair.p_holm)])));
}

function flags_table(flags) {
  if (!flags.length) return null;
  return h("section", { class: "card" }, h("h3", {}, "Flags"),
    h("p", { class: "small" }, "Reasons to look again. Nobody is left out because of them unless you choose the set without them."),
    plain_table("Flags of participants", ["Participant", "Flag", "Value", "Threshold"], flags.map((flag) =>
      [flag.participant, flag.flag.replaceAll("_", " "), significant(flag.value), significant(flag.threshold)]), { captioned: false }));
}

/// Results that are updated while answers come in. The choice of participants stays as it is, focus
/// and an open list included: only what depends on the answers is replaced.
export class Results {
  constructor() {
    this.choice = h("select", { id: "included", on: { change: () => this.draw() } });
    this.body = h("div", {});
    this.content = h("div", { hidden: true }, h("h2", {}, "Results"),
      h("p", { class: "choose" }, h("label", { for: "included" }, "Participants"), this.choice),
      h("p", { class: "small" }, "Rank 1 is most realistic. Tables show means weighted by how easy the differences were to see; techniques in one column do not differ significantly."),
      this.body);
    this.note = h("p", { hidden: true }, "No answers yet.");
    this.element = h("section", {}, this.note, this.content);
  }

  update(results, study) {
    Object.assign(this, { results, study });
    const names = Object.keys(results.included_sets);
    this.content.hidden = !results.pages || !names.length;
    this.note.hidden = !this.content.hidden;
    if (this.content.hidden) return;
    const offered = [...this.choice.options].map(({ value }) => value);
    if (offered.join() !== names.join()) {
      const chosen = this.choice.value;
      this.choice.replaceChildren(...names.map((name) => h("option", { value: name }, sets[name] ?? name)));
      if (names.includes(chosen)) this.choice.value = chosen;
    }
    this.draw();
  }

  draw() {
    const { results, study } = this;
    const alpha = study.document.analysis?.alpha ?? 0.05;
    const label = labels_of(study);
    const part = results.included_sets[this.choice.value];
    this.body.replaceChildren(...[
      part.overall?.techniques?.length ? part_section("All scenes", part.overall, label, alpha) : null,
      part.scenes.filter((scene) => scene.techniques.length).map((scene) => part_section(scene.scene, scene, label, alpha)),
      arms_section(results.arms),
      flags_table(results.flags ?? []),
    ].flat().filter(Boolean));
  }
}
