// The list twin of the plan: type what is sought, walk the hits with the arrows, Enter chooses.

import { element } from "./dom.js";

const MOST = 40;

export function letSearch(board) {
  const box = board.section.querySelector(".search");
  const input = box.querySelector("input"), list = box.querySelector("ul");
  box.hidden = false;
  const words = new Map(Object.entries(board.nodes).map(([id, facts]) =>
    [id, [id, board.told(id), ...Object.keys(facts.belief || {}).slice(0, 3),
      ...Object.keys(facts.affords || {}), facts.room || "", facts.movability || "",
      facts.on || ""].join(" ").toLowerCase()]));
  let at = -1;

  const close = () => {
    list.hidden = true;
    list.replaceChildren();
    input.setAttribute("aria-expanded", "false");
    input.removeAttribute("aria-activedescendant");
    at = -1;
    board.light([]);
  };
  const stand = (where) => {
    list.children[at]?.setAttribute("aria-selected", "false");
    at = (where + list.children.length) % list.children.length;
    const option = list.children[at];
    option.setAttribute("aria-selected", "true");
    option.scrollIntoView({ block: "nearest" });
    input.setAttribute("aria-activedescendant", option.id);
  };
  const choose = (id) => {
    close();
    board.choose(id, "list");
  };
  const search = () => {
    const wanted = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    if (!wanted.length) {
      close();
      return;
    }
    const hits = [...words].filter(([, text]) => wanted.every((w) => text.includes(w)))
      .map(([id]) => id);
    list.replaceChildren(...hits.slice(0, MOST).map((id, number) => element("li",
      { role: "option", id: `found-${number}`, "aria-selected": "false",
        onpointerdown: (event) => event.preventDefault(), onclick: () => choose(id) },
      element("b", {}, id), ` ${board.told(id)}`)));
    if (!hits.length) list.replaceChildren(element("li", { class: "none" }, "nothing found"));
    list.hidden = false;
    at = -1;
    input.setAttribute("aria-expanded", "true");
    board.light(hits.slice(0, MOST));
    board.say(`${hits.length} found`);
  };

  input.addEventListener("input", search);
  input.addEventListener("focus", search);
  input.addEventListener("blur", close);
  input.addEventListener("keydown", (event) => {
    const options = list.querySelectorAll("[role=option]").length;
    if (event.key === "Escape") {
      input.value = "";
      close();
    } else if (!options) {
      return;
    } else if (event.key === "ArrowDown") {
      stand(at + 1);
    } else if (event.key === "ArrowUp") {
      stand(at < 0 ? options - 1 : at - 1);
    } else if (event.key === "Enter") {
      list.children[Math.max(at, 0)].click();
    } else {
      return;
    }
    event.preventDefault();
  });
}
