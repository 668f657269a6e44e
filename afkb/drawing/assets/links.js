// Draws what the chosen node rests on: lines to other nodes, and where a predicted thing may be.

import { inDrawing } from "./choosing.js";

const LINKS = { on: "to-support", part_of: "to-support", from: "to-anchor", seen_as: "to-anchor",
  seen_from: "to-view" };

export function drawLinks(board) {
  const { svg, nodes } = board;
  const layer = make("g", { class: "links", "aria-hidden": "true" });
  svg.insertBefore(layer, svg.querySelector(".things"));
  function make(name, attributes) {
    const made = document.createElementNS(svg.namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
  }
  board.addEventListener("choose", ({ detail: { id } }) => {
    layer.replaceChildren();
    if (!id || nodes[id].x == null) return;
    const { region } = nodes[id];
    const most = Math.max(...(region?.parts || []).map((p) => p[2]));
    for (const [x, y, share] of region?.parts || []) {
      const [cx, cy] = inDrawing({ x, y }), side = region.side * 100;
      layer.append(make("rect", { class: "may-be", x: cx - side / 2, y: cy - side / 2, width: side,
        height: side, "fill-opacity": (0.55 * share) / most }));
    }
    const [x1, y1] = inDrawing(nodes[id]);
    for (const [key, kind] of Object.entries(LINKS)) {
      for (const other of [nodes[id][key] || []].flat()) {
        if (nodes[other]?.x == null) continue;
        const [x2, y2] = inDrawing(nodes[other]);
        layer.append(make("line", { class: kind, x1, y1, x2, y2 }));
      }
    }
  });
}
