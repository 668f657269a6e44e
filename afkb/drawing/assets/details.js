// The panel beside the plan: what is believed of the chosen node, and the evidence behind it.

import { element, figure, present, tableOf } from "./dom.js";

const STEPS = {
  Sighted: "seen", SeenThrough: "seen through", Overlooked: "in clear view and not detected",
  Surrounded: "told by what is around it", Aged: "time passed", Predicted: "predicted",
  PredictedAgain: "predicted again", WalledOff: "a wall came to light between",
  EvidenceGone: "what it follows from is gone", Confirmed: "seen, and so confirmed",
};
const RELATIONS = [["on", "stands on"], ["part_of", "part of"], ["room", "in"], ["rooms", "leads to"],
  ["from", "predicted from"], ["seen_as", "was then seen as"], ["seen_from", "seen from"]];

export function showDetails(board, { more = null, back = () => {} } = {}) {
  const panel = board.section.querySelector(".details");
  const close = () => {
    board.choose(null);
    back();
  };
  panel.addEventListener("keydown", (event) => {
    if (event.key === "Escape") close();
  });
  board.addEventListener("choose", ({ detail: { id, by } }) => {
    panel.hidden = !id;
    board.section.classList.toggle("explained", Boolean(id));
    if (!id) {
      panel.replaceChildren();
      return;
    }
    const facts = board.nodes[id];
    panel.replaceChildren(...present([
      element("button", { type: "button", class: "close", "aria-label": "Close", onclick: close }, "×"),
      element("h3", {}, id),
      element("p", { class: "told" }, board.told(id)),
      bars("may be", facts.kind === "Room" ? null : facts.belief),
      bars("for", facts.kind === "Room" ? facts.belief : null),
      ...Object.entries(facts.other_beliefs || {}).map(([who, belief]) => bars(`by ${who}`, belief)),
      bars("affords", facts.affords),
      relations(board, facts),
      measured(facts),
      evidence(facts)]));
    if (more) more(id, panel);
    panel.scrollTop = 0;
    if (by === "keyboard" || by === "list") panel.focus({ preventScroll: by === "keyboard" });
  });
}

export function bars(title, belief) {
  const told = Object.entries(belief || {});
  if (!told.length) return null;
  return element("div", { class: "bars" }, element("h4", {}, title), told.map(([name, p]) => {
    const fill = element("span");
    fill.style.width = `${100 * p}%`;
    return element("div", { class: "bar" }, fill, element("b", {}, name), ` ${figure(p)}`);
  }));
}

function relations(board, facts) {
  const seen = facts.kind === "ObservedEntity";
  const rows = RELATIONS.filter(([key]) => facts[key]).map(([key, told]) => [
    element("dt", {}, key === "from" && seen ? `was ${told}` : told),
    element("dd", {}, [facts[key]].flat().map((id) => board.nodes[id]
      ? element("button", { type: "button", class: "node-link",
        onclick: () => board.choose(id, "list") }, id)
      : element("span", {}, id))),
  ]);
  return rows.length ? element("dl", {}, rows) : null;
}

function measured(facts) {
  const told = {
    height: facts.z == null ? null : `${figure(facts.z)} m`,
    size: facts.size && `${facts.size.map((s) => figure(s)).join(" × ")} m${
      facts.extent_known === false ? " (not known)" : ""}`,
    area: facts.area == null ? null : `${figure(facts.area, 1)} m²`,
    width: facts.width == null ? null : `${figure(facts.width)} m`,
    moves: facts.movability?.toLowerCase(),
    views: facts.observations,
    "first seen": facts.first_seen == null ? null : `${figure(facts.first_seen, 1)} s`,
    "last seen": facts.last_seen == null ? null : `${figure(facts.last_seen, 1)} s`,
    "told of by": facts.by?.join(", "),
    follows: facts.axioms?.join(", "),
    counted: facts.evidence
      && Object.entries(facts.evidence).map(([name, n]) => `${n} ${name}`).join(", "),
  };
  return element("dl", {}, Object.entries(told).filter(([, text]) => text != null && text !== "")
    .map(([name, text]) => [element("dt", {}, name), element("dd", {}, String(text))]));
}

function evidence(facts) {
  const found = [];
  if (facts.steps) {
    found.push(tableOf(["at (s)", "view", "what", "weighs", "before", "after"],
      facts.steps.map((s) => [figure(s.stamp, 1), s.view ?? "", STEPS[s.kind] || s.kind,
        figure(s.weighed, 3), s.before == null ? "" : figure(s.before, 3), figure(s.after, 3)]),
      "Why it is held to exist"));
  }
  if (facts.sightings) {
    found.push(tableOf(["view", "at (s)", "from (m)", "pixels", "box", "detectors", "told"],
      facts.sightings.map((s) => [s.view, figure(s.stamp, 1), figure(s.range), s.pixels,
        s.box ? s.box.join(", ") : "", s.by.join(" and "),
        Object.entries(s.affords).map(([name, p]) => `${name} ${figure(p)}`).join(", ")]),
      "The views that show most of it"));
  }
  return element("div", { class: "evidence" }, found);
}
