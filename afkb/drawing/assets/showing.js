// Puts the parts of the plan together, for whichever page it stands on.

import { Board } from "./board.js";
import { letChoose } from "./choosing.js";
import { showDetails } from "./details.js";
import { decoded } from "./dom.js";
import { letHide } from "./layers.js";
import { drawLinks } from "./links.js";
import { letTimePass } from "./moments.js";
import { Panning } from "./panning.js";
import { letSearch } from "./searching.js";

export function showPlan(section, drawing, { wheel, more = null }) {
  const board = new Board(section, drawing);
  const panning = new Panning(board, wheel);
  letHide(board);
  const { back } = letChoose(board, panning);
  showDetails(board, { more, back });
  drawLinks(board);
  letSearch(board);
  letTimePass(board);
  const named = () => decoded(location.hash.slice(1));
  addEventListener("hashchange", function heard() {
    if (board.section.isConnected) board.choose(named(), "list");
    else removeEventListener("hashchange", heard); // Another plan stands in its place.
  });
  board.addEventListener("choose", ({ detail: { id } }) => {
    const hash = id ? `#${encodeURIComponent(id)}` : location.pathname + location.search;
    try {
      history.replaceState(null, "", hash);
    } catch { /* A page from disk may not rename itself. */ }
  });
  if (drawing.nodes[named()]) board.choose(named(), "link");
  return { board, panning };
}
