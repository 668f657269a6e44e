// The report: its plan, its table of things, and the timings beside it.

import { showPlan } from "./showing.js";
import { letChooseTheme } from "./theme.js";

letChooseTheme(document.querySelector(".theme"));
const drawing = JSON.parse(document.getElementById("drawing").textContent);
const { board } = showPlan(document.querySelector(".map"), drawing, { wheel: "ctrl" });
document.querySelector(".keys").append(" Ctrl and the wheel or + and − zoom, dragging or the"
  + " arrows move, a double click or 0 shows the whole; a click or Enter tells the evidence.");

// Rows of the table and nodes of the plan light each other up.
const rows = new Map([...document.querySelectorAll("tr[data-id]")]
  .map((row) => [row.dataset.id, row]));
for (const [id, row] of rows) {
  row.addEventListener("pointerenter", () => board.light([id]));
  row.addEventListener("pointerleave", () => board.light([]));
  row.addEventListener("focusin", () => board.light([id]));
  row.addEventListener("focusout", () => board.light([]));
}
board.svg.addEventListener("pointerover", (event) => mark(board.nodeAt(event.target)));
board.svg.addEventListener("focusin", (event) => mark(board.nodeAt(event.target)));
board.svg.addEventListener("pointerleave", () => mark(board.chosen));
board.addEventListener("choose", ({ detail: { id } }) => mark(id));
function mark(id) {
  for (const [of, row] of rows) row.classList.toggle("lit", of === id);
}

// Fills in the timings where the browser lets a page read its neighbour: over http, not from
// disk. There run.json is shown as it is, in the frame below the table.
const cells = [...document.querySelectorAll("[data-seconds]")];
async function readTimings() {
  if (location.protocol === "file:") throw new Error("a page from disk can't read its neighbour");
  const { seconds = {} } = await (await fetch("run.json")).json();
  for (const cell of cells) {
    if (seconds[cell.dataset.seconds] !== undefined) {
      cell.textContent = seconds[cell.dataset.seconds].toFixed(3);
    }
  }
  document.getElementById("run").remove();
}
readTimings().catch(() => {
  for (const cell of cells) cell.textContent = "see below";
});
