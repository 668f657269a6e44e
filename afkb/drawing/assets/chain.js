// The evidence chain of `afkb why`, recomputed by the server, in the panel of the chosen node.

import { bars } from "./details.js";
import { element, figure, tableOf } from "./dom.js";
import { askJson } from "./fetching.js";

const STATES = 3;

// Returns what showDetails calls with the node and the panel, for the map that `which` names.
export function explaining(which) {
  let wanted = 0;
  return async (id, panel) => {
    const mine = (wanted += 1);
    const slot = element("div", { class: "why", "aria-busy": "true" }, "recomputing the chain …");
    panel.append(slot);
    let told;
    try {
      told = tell(await askJson(`api/maps/${encodeURIComponent(which())}/why/${encodeURIComponent(id)}`));
    } catch (error) {
      told = [element("p", { class: "trouble" }, error.message)];
    }
    if (mine !== wanted) return;
    slot.removeAttribute("aria-busy");
    slot.replaceChildren(element("h3", {}, "Why"), ...told);
  };
}

function tell(why) {
  const told = [element("p", {}, why.told)];
  if (why.grounds.length) {
    told.push(tableOf(["what", "how"], why.grounds.map((g) => [g.id, g.how]), "It rests on"));
  }
  if (why.belief) told.push(...beliefs(why.belief));
  if (why.existence) told.push(...whatIf(why.existence.what_if, "What would change its existence most"));
  const lines = statements(why);
  if (lines.length) {
    told.push(element("details", {}, element("summary", {}, `${lines.length} statements behind it`),
      element("ul", {}, lines.map((line) => element("li", {}, line)))));
  }
  return [...told, ...why.notes.map((note) => element("p", { class: "hint" }, `note: ${note}`))];
}

const percent = (p) => (p == null ? "" : p < 0.001 ? p.toExponential(1) : figure(p, 3));

function beliefs({ about, evidence, prior, recomputed, what_if: changes }) {
  const states = Object.entries(recomputed).sort((a, b) => b[1] - a[1]).slice(0, STATES)
    .map(([name]) => name);
  const rows = [["before any evidence", "", ...states.map((s) => percent(prior[s]))],
    ...evidence.map((row) => [row.evidence, row.observed,
      ...states.map((s) => percent(row.likelihood[s]))]),
    ["so that it is", "", ...states.map((s) => percent(recomputed[s]))]];
  const shown = Object.fromEntries(states.map((s) => [s, recomputed[s]]));
  return [bars(`${about}, recomputed`, shown),
    tableOf(["evidence", "observed", ...states], rows, `How that comes about: ${about}`),
    ...whatIf(changes, `What would change ${about} most`)];
}

function whatIf(changes, caption) {
  const rows = changes.filter(({ moved }) => moved >= 0.005).slice(0, 6).map((change) => {
    const [name, p] = Object.entries(change.belief)[0];
    return [change.what, percent(change.probability), figure(change.moved),
      `${name} ${figure(p)}`];
  });
  return rows.length ? [tableOf(["what", "probable", "moves", "then"], rows, caption)] : [];
}

function statements({ grounds, belief }) {
  const lines = grounds.filter((g) => g.statement).map((g) => `rule: ${line(g.statement)}`);
  for (const row of belief?.evidence || []) {
    for (const [state, sources] of Object.entries(row.statements).slice(0, STATES)) {
      lines.push(...sources.map((source) => `${state}, ${row.evidence}: ${line(source)}`));
    }
  }
  return lines;
}

const line = (source) => Object.values(source).filter((v) => v != null && v !== "").join("; ");
