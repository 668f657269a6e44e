// Parameters of a query of the library: lines of its text that fields beside it rewrite.

import { element } from "./dom.js";

const LINE = /VALUES \?(\w+) \{ (\S+) \}(?=  # parameter, (afn:|scene:|number):? (.+))/g;
const NAME = /^[\w%][\w%.-]*$/, NUMBER = /^[+-]?\d+(\.\d+)?$/;

export function letFill(place, box) {
  let shown = "";
  const fill = (name, kind, field) => {
    const right = (kind === "number" ? NUMBER : NAME).test(field.value);
    field.setCustomValidity(right ? "" : kind === "number" ? "a number" : "a name without spaces");
    field.reportValidity();
    if (!right) return;
    const told = (kind === "number" ? "" : kind) + field.value;
    box.value = box.value.replaceAll(LINE, (line, of) =>
      (of === name ? `VALUES ?${name} { ${told} }` : line));
  };
  return {
    // Fields for what the text takes; the same ones as long as it takes the same.
    show() {
      const found = [...box.value.matchAll(LINE)];
      const takes = found.map(([, name]) => name).join(" ");
      if (takes === shown) return;
      shown = takes;
      place.replaceChildren(...found.map(([, name, value, kind, about]) => {
        const field = element("input", { type: "text", "data-kind": kind, autocomplete: "off",
          value: value.replace(/^(afn|scene):/, ""),
          oninput: (event) => fill(name, kind, event.target) });
        return element("label", {}, `${name}, ${about} `, field);
      }));
    },
    // A chosen node is what a query about one node is asked of.
    choose(id) {
      const field = place.querySelector("[data-kind='scene:']");
      if (!field) return;
      field.value = encodeURIComponent(id);
      field.dispatchEvent(new Event("input"));
    },
  };
}
