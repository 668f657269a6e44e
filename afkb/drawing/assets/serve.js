// The page of a server: chooses a map, shows its plan, explains its nodes, and asks it.

import { letAsk } from "./asking.js";
import { explaining } from "./chain.js";
import { element } from "./dom.js";
import { askJson } from "./fetching.js";
import { showPlan } from "./showing.js";
import { letChooseTheme } from "./theme.js";

const LOOK_AGAIN_MS = 5000;
const SVG = "http://www.w3.org/2000/svg";

const which = document.getElementById("which");
const trouble = document.querySelector("p.trouble");
const bare = document.querySelector(".map").cloneNode(true);
const shown = { board: null, base: "", graph: "" };
let asking = null;

letChooseTheme(document.querySelector(".theme"));
asking = letAsk(document.querySelector(".asking"), () => shown);
which.addEventListener("change", () => show(which.value));
begin();

async function begin() {
  try {
    const maps = await askJson("api/maps");
    which.replaceChildren(...maps.map(({ name, graph }) =>
      element("option", { value: name, "data-graph": graph }, name)));
    const wanted = new URLSearchParams(location.search).get("map");
    document.getElementById("this-map").closest("label").hidden = maps.length < 2;
    which.value = maps.some(({ name }) => name === wanted) ? wanted : maps[0].name;
    await show(which.value);
  } catch (error) {
    tell(error.message);
  }
}

async function show(name) {
  try {
    const plan = await askJson(`api/maps/${encodeURIComponent(name)}/plan`);
    if (name !== which.value) return;
    tell("");
    asking.clear();
    const section = bare.cloneNode(true);
    document.querySelector(".map").replaceWith(section);
    section.querySelector(".sheet").append(parsed(plan.svg));
    shown.board = showPlan(section, plan,
      { wheel: "always", more: explaining(() => which.value) }).board;
    shown.base = plan.base;
    shown.graph = which.selectedOptions[0].dataset.graph;
    shown.board.addEventListener("choose", ({ detail: { id } }) => asking.mark(id));
    section.querySelector(".keys").append(" The wheel or + and − zoom, dragging or the arrows move,"
      + " 0 shows the whole; a click or Enter on a node tells the evidence, Escape goes back.");
    document.querySelector(".summary").textContent = plan.summary;
    document.title = `${name}: topological affordance map`;
    if (which.options.length > 1) history.replaceState(null, "", `?map=${encodeURIComponent(name)}${location.hash}`);
  } catch (error) {
    tell(error.message);
  }
}

// As an image's XML, not as HTML: nothing in it can run.
function parsed(svg) {
  const spaced = svg.replace("<svg ", `<svg xmlns="${SVG}" `);
  const whole = new DOMParser().parseFromString(spaced, "image/svg+xml");
  return document.importNode(whole.documentElement, true);
}

function tell(words) {
  trouble.textContent = words;
  trouble.hidden = !words;
}

// A map that is written anew while it is served is shown anew.
let served = null;
setInterval(async () => {
  if (document.hidden) return;
  try {
    const now = (await fetch("api/maps", { method: "HEAD" })).headers.get("X-AFKB-Maps");
    if (served !== null && now !== null && now !== served) await begin();
    served = now;
  } catch { /* The server is gone; the next question says so. */ }
}, LOOK_AGAIN_MS);
