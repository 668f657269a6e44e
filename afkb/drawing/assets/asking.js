// The query box: the library, an own query, and an answer whose rows and nodes light each other up.

import { decoded, element } from "./dom.js";
import { ask, askJson } from "./fetching.js";
import { letFill } from "./parameters.js";

const SHOWN = 500;
// What is asked along with one map: the ontology, and what follows from it.
const KNOWN = ["urn:afkb:ontology", "urn:afkb:inferred", "urn:afkb:believed"];
const ACCEPTED = "application/sparql-results+json, text/turtle;q=0.8, application/json;q=0.5";
const GREETING = "SELECT ?thing ?category ?probability {\n"
  + "  ?thing a afn:ObservedEntity ;\n         afn:categoryBelief ?b .\n"
  + "  ?b afn:category ?category ;\n     afn:probability ?probability .\n"
  + "  FILTER (?probability > 0.5)\n}\nORDER BY DESC(?probability)";

// shown(): { board, base, graph } of the map on the page.
export function letAsk(section, shown) {
  const form = section.querySelector("form"), box = section.querySelector("#sparql");
  const library = section.querySelector("#library"), about = section.querySelector(".about");
  const stop = section.querySelector(".stop"), status = section.querySelector(".answered");
  const place = section.querySelector(".answer"), only = section.querySelector("#this-map");
  const found = new Map();
  const parameters = letFill(section.querySelector(".parameters"), box);
  let running = null;
  box.value = GREETING;

  askJson("api/queries").then((queries) => {
    for (const query of queries) {
      found.set(query.name, query);
      library.append(element("option", { value: query.name }, query.name));
    }
  }).catch((error) => { status.textContent = error.message; });
  library.addEventListener("change", () => {
    const query = found.get(library.value);
    about.textContent = query?.about || "";
    if (query) box.value = query.sparql;
    parameters.show();
    if (shown().board?.chosen) parameters.choose(shown().board.chosen);
  });
  box.addEventListener("input", () => parameters.show());
  box.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) form.requestSubmit();
  });
  stop.addEventListener("click", () => running?.abort());
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    answer();
  });

  // `scene:` is for nodes of the map that is shown, whichever the server holds for the first.
  const text = () => (/\bscene:/.test(box.value) && !/prefix\s+scene:/i.test(box.value)
    ? `PREFIX scene: <${shown().base}> ${box.value}` : box.value);

  async function answer() {
    running?.abort();
    const mine = running = new AbortController();
    stop.hidden = false;
    status.textContent = "asking …";
    place.replaceChildren();
    shown().board?.light([]);
    const started = performance.now();
    // A query that tells graphs apart is about all of them.
    const one = only.checked && !only.closest("label").hidden && !/\bGRAPH\b/i.test(box.value);
    const asked = one ? [shown().graph, ...KNOWN] : [];
    const graphs = new URLSearchParams(asked.map((graph) => ["default-graph-uri", graph]));
    try {
      const got = await ask(`sparql?${graphs}`, { method: "POST", body: text(), signal: mine.signal,
        headers: { "Content-Type": "application/sparql-query", Accept: ACCEPTED } });
      const type = got.headers.get("Content-Type") || "";
      const result = type.includes("json") ? await got.json() : await got.text();
      if (mine !== running) return;
      const took = `${Math.round(performance.now() - started)} ms`;
      status.textContent = `${show(result)}, ${took}`;
    } catch (error) {
      if (mine !== running) return;
      status.textContent = error.name === "AbortError" ? "stopped" : `error: ${error.message}`;
    }
    stop.hidden = true;
  }

  function show(result) {
    if (typeof result === "string") {
      place.append(element("pre", { tabindex: "0" }, result));
      return "a graph";
    }
    if ("boolean" in result) return result.boolean ? "yes" : "no";
    const { vars } = result.head, all = result.results.bindings;
    place.append(rows(vars, all.slice(0, SHOWN)));
    const lit = lightAll();
    return `${all.length} ${all.length === 1 ? "row" : "rows"}`
      + `${all.length > SHOWN ? `, the first ${SHOWN} of them shown` : ""}, ${lit} nodes lit`;
  }

  function rows(vars, bindings) {
    const { board, base } = shown();
    const cell = (binding) => {
      if (!binding) return element("td");
      const id = nodeOf(board, base, binding);
      if (!id) return element("td", { title: binding.value }, short(binding));
      return element("td", { "data-node": id }, element("button", { type: "button",
        class: "node-link", onclick: () => board.choose(id, "list") }, id));
    };
    return element("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Answer" },
      element("table", {},
        element("thead", {}, element("tr", {}, vars.map((v) => element("th", { scope: "col" }, v)))),
        element("tbody", {}, bindings.map((b) => element("tr", {}, vars.map((v) => cell(b[v])))))));
  }

  const nodesIn = (part) => [...part.querySelectorAll("[data-node]")].map((c) => c.dataset.node);
  const lightAll = () => shown().board?.light(nodesIn(place)) ?? 0;
  const over = (event) => {
    const row = event.target.closest("tbody tr");
    if (row) shown().board?.light(nodesIn(row));
  };
  place.addEventListener("pointerover", over);
  place.addEventListener("focusin", over);
  place.addEventListener("pointerleave", lightAll);
  place.addEventListener("focusout", lightAll);

  // Marks the rows that tell of a node, and brings the first of them into view.
  return {
    mark(id) {
      if (id) parameters.choose(id);
      let first = null;
      for (const row of place.querySelectorAll("tbody tr")) {
        const tells = nodesIn(row).includes(id);
        row.classList.toggle("lit", tells);
        if (tells) first ??= row;
      }
      first?.scrollIntoView({ block: "nearest" });
    },
    clear() {
      place.replaceChildren();
      status.textContent = "";
    },
  };
}

function nodeOf(board, base, { type, value }) {
  if (!board || type !== "uri" || !value.startsWith(base)) return null;
  const id = decoded(value.slice(base.length));
  return board.nodes[id] ? id : null;
}

const PLACES = 4;

function short({ type, value, datatype = "" }) {
  if (type === "uri") return decodeURIComponent(value.split(/[#/]/).at(-1)) || value;
  return /#(double|decimal|float)$/.test(datatype) ? String(+Number(value).toFixed(PLACES)) : value;
}
