// Who took part in a version of a study, under pseudonyms: flags with their reasons, what happened
// when, and taking people out or back.

import { h } from "/assets/shared/dom.js";
import { get, put } from "/assets/shared/http.js";
import { ask } from "./dialogs.js";
import { significant, words_of } from "./words.js";

const outcomes = { started: "started", completed: "completed", screened_out: "ended by a check" };

const clock = (time) => (time ? new Date(time).toLocaleString() : "");
const times = (count) => (count === 1 ? "once" : `${count} times`);
const name_of = (flag) => flag.replaceAll("_", " ");

function evidence_of({ evidence }) {
  if (!evidence) return "";
  return `. The true picture has the worst place on ${evidence.reference_last} of ${evidence.pages} pages; `
    + `the order was turned round before it was sent on ${evidence.turned_round}`;
}

function flag_items(flags) {
  return h("ul", { class: "flags" }, flags.map((flag) => h("li", {}, h("strong", {}, name_of(flag.flag)),
    `: ${flag.reason} (${significant(flag.value)}, threshold ${significant(flag.threshold)})${evidence_of(flag)}`)));
}

function timeline(person) {
  const what = (answer) => `${answer.kind === "ranking" ? "page" : answer.kind} ${answer.page_index + 1} (${answer.page})`
    + `${answer.current ? "" : ", replaced later"}`
    + `${answer.active_ms === null ? "" : `, ${significant(answer.active_ms / 1000)} s`}`
    + `${answer.swaps ? `, turned round ${times(answer.swaps)}` : ""}${answer.blurs ? `, left the window ${times(answer.blurs)}` : ""}`;
  const steps = [
    { at: person.entered_at, text: "entered" },
    ...person.timeline.map((answer) => ({ at: answer.at, text: what(answer) })),
    ...(person.completed_at ? [{ at: person.completed_at, text: "finished" }] : []),
    ...person.history.map(({ at, excluded, reason }) => ({ at, text: `${excluded ? "taken out" : "taken back"}: ${reason}` })),
  ].sort((a, b) => (a.at < b.at ? -1 : a.at > b.at ? 1 : 0));
  return h("details", { class: "timeline" }, h("summary", {}, "Timeline"),
    h("ol", {}, steps.map(({ at, text }) => h("li", {}, h("time", { datetime: at }, clock(at)), ` ${text}`))));
}

class PeopleView {
  constructor(id, version, list) {
    Object.assign(this, { id, version, list });
    this.problem = h("p", { class: "problems", role: "alert" });
    this.body = h("tbody", {});
    this.only_flagged = h("input", { type: "checkbox", id: "only-flagged", on: { change: () => this.draw() } });
    this.element = h("div", {},
      h("p", {}, h("a", { href: `#study/${encodeURIComponent(id)}/${version}` }, "Back to the study")),
      h("h1", { tabindex: "-1" }, `Participants of ${id}, version ${version}`),
      h("section", { class: "card" },
        h("p", {}, "Flags are reasons to look again; they change nothing by themselves. Whom you take out is left aside in all results, stays in the exports marked so, and can be taken back."),
        h("p", {}, h("label", { class: "choice", for: "only-flagged" }, this.only_flagged, h("span", {}, "Only people with flags"))),
        this.problem,
        h("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Participants" },
          h("table", { class: "plain people" }, h("thead", {}, h("tr", {}, ["Participant", "Progress", "Flags and timeline", "Results"]
            .map((name) => h("th", { scope: "col" }, name)))), this.body))));
    this.draw();
  }

  draw() {
    const shown = this.list.filter((person) => !this.only_flagged.checked || person.flags.length);
    this.body.replaceChildren(...(shown.length ? shown.map((person) => this.row(person))
      : [h("tr", {}, h("td", { colspan: "4" }, "Nobody to show."))]));
  }

  row(person) {
    return h("tr", { class: person.excluded ? "excluded" : "" },
      h("th", { scope: "row" }, h("code", {}, person.participant), person.test ? h("span", { class: "badge" }, "preview") : null,
        person.arm ? [h("br"), h("small", {}, person.arm)] : null),
      h("td", {}, `${outcomes[person.outcome]}, ${person.answered} of ${person.pages} pages`, h("br"), h("small", {}, clock(person.entered_at))),
      h("td", {}, person.flags.length ? flag_items(person.flags) : h("span", { class: "small" }, "no flags"), timeline(person)),
      h("td", {}, person.test ? h("span", { class: "small" }, "never counted")
        : [person.excluded ? h("p", { class: "small" }, `taken out: ${person.exclusion_reason}`) : null, this.decision(person)]));
  }

  decision(person) {
    const button = h("button", { type: "button", class: "quiet" }, person.excluded ? "Take back" : "Take out");
    button.addEventListener("click", async () => {
      const reason = await ask({
        title: person.excluded ? `Take ${person.participant} back?` : `Take ${person.participant} out?`,
        text: person.excluded ? "The answers count again." : "The answers are left aside in all results. Nothing is deleted.",
        action: person.excluded ? "Take back" : "Take out", reason: "Reason, kept with the decision" });
      if (reason === null) return;
      try {
        const at = `/api/v1/studies/${encodeURIComponent(this.id)}/participants/${encodeURIComponent(person.participant)}/exclusion?version=${this.version}`;
        const changed = await put(at, { excluded: !person.excluded, reason });
        this.list = this.list.map((one) => (one.participant === changed.participant ? changed : one));
        this.problem.textContent = "";
        this.draw();
      } catch (error) {
        this.problem.textContent = words_of(error);
      }
    });
    return button;
  }
}

export async function people_view(id, version) {
  const { participants } = await get(`/api/v1/studies/${encodeURIComponent(id)}/participants?version=${version}`);
  return new PeopleView(id, version, participants).element;
}
