// The plan on a page: which element stands for which node, what is chosen, what is lit up.

const MARKS = ".node, .place, .room, .doorway, .bound";
const LIT = `${MARKS}, .outline, .way`;

export class Board extends EventTarget {
  // section: the page's .map with the SVG in it; drawing: { nodes, time } of the map.
  constructor(section, drawing) {
    super();
    this.section = section;
    this.svg = section.querySelector(".plan");
    this.nodes = drawing.nodes;
    this.times = drawing.time;
    this.chosen = null;
    this.elements = new Map();
    for (const drawn of this.svg.querySelectorAll("[data-id]")) {
      const id = drawn.dataset.id;
      this.elements.set(id, [...(this.elements.get(id) || []), drawn]);
    }
  }

  // The element of a node that takes the keyboard's focus: the last mark that is drawn of it.
  mark(id) {
    return (this.elements.get(id) || []).findLast((drawn) => drawn.matches(MARKS));
  }

  nodeAt(target) {
    const drawn = target.closest?.("[data-id]");
    return drawn && this.nodes[drawn.dataset.id] ? drawn.dataset.id : null;
  }

  // How a node is told in a few words: what it is, how sure, whether it was seen.
  told(id) {
    const { kind, belief = {}, existence, state, was } = this.nodes[id];
    const [likeliest] = Object.entries(belief);
    const name = likeliest ? `${likeliest[0]} ${likeliest[1].toFixed(2)}` : "";
    const how = { ObservedEntity: "seen", DualPrediction: "predicted by duality",
      CoOccurrencePrediction: "predicted by co-occurrence", RobotPlace: "robot place",
      PastPrediction: `was predicted, ${(state || "").toLowerCase()}` }[kind] || kind.toLowerCase();
    const sure = existence == null || was ? "" : `exists ${existence.toFixed(2)}`;
    return [name, how, sure].filter(Boolean).join(", ");
  }

  choose(id, by = "") {
    for (const drawn of this.elements.get(this.chosen) || []) drawn.classList.remove("chosen");
    this.chosen = id && this.nodes[id] ? id : null;
    for (const drawn of this.elements.get(this.chosen) || []) drawn.classList.add("chosen");
    this.dispatchEvent(new CustomEvent("choose", { detail: { id: this.chosen, by } }));
    this.say(this.chosen ? `${this.chosen}: ${this.told(this.chosen)}` : "");
  }

  // Lights nodes up, above all else that is dimmed; none: everything as usual.
  light(ids) {
    const known = [...new Set(ids)].filter((id) => this.elements.has(id));
    const kept = known.length && this.chosen ? [...known, this.chosen] : known;
    const marks = kept.flatMap((id) => (this.elements.get(id) || []).filter((d) => d.matches(LIT)));
    this.lights ??= this.#layer();
    this.lights.replaceChildren(...marks.map((drawn) => {
      const copy = drawn.cloneNode();
      for (const name of ["data-id", "role", "tabindex", "aria-label"]) copy.removeAttribute(name);
      copy.classList.add("lit");
      return copy;
    }));
    this.svg.classList.toggle("dimmed", known.length > 0);
    return known.length;
  }

  #layer() {
    const layer = document.createElementNS(this.svg.namespaceURI, "g");
    layer.setAttribute("class", "lights things");
    layer.setAttribute("aria-hidden", "true");
    this.svg.append(layer);
    return layer;
  }

  // Told to who hears the page.
  say(words) {
    this.section.querySelector(".spoken").textContent = words;
  }
}
