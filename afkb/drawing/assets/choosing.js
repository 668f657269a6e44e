// Chooses nodes on the plan: a click, or the keyboard, which walks from node to node.

const SCALE = 100;
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const WALKED = new Set(["ObservedEntity", "DualPrediction", "CoOccurrencePrediction",
  "RobotPlace", "Room", "Doorway"]);

export const inDrawing = ({ x, y }) => [x * SCALE, -y * SCALE];

export function letChoose(board, panning) {
  const { svg, nodes } = board;
  svg.setAttribute("role", "group");
  svg.setAttribute("aria-label", "Plan of the map. Arrows move it, plus and minus zoom, 0 shows "
    + "all of it; Tab goes to the nodes: there arrows walk, Enter chooses, Escape goes back.");
  const walked = Object.keys(nodes).filter((id) => WALKED.has(nodes[id].kind) && board.mark(id));
  for (const id of walked) {
    const mark = board.mark(id);
    mark.setAttribute("role", "button");
    mark.setAttribute("tabindex", "-1");
    mark.setAttribute("aria-label", `${id}: ${board.told(id)}`);
  }
  let here = walked[0];
  const stand = (id) => {
    board.mark(here)?.setAttribute("tabindex", "-1");
    here = id;
    board.mark(here)?.setAttribute("tabindex", "0");
  };
  if (here) stand(here);

  const shown = (id) => board.mark(id).getClientRects().length > 0;
  const next = ([right, down]) => {
    const [x, y] = inDrawing(nodes[here]);
    let best = null, least = Infinity;
    for (const id of walked) {
      const [nx, ny] = inDrawing(nodes[id]);
      const ahead = (nx - x) * right + (ny - y) * down;
      const aside = Math.abs((nx - x) * down) + Math.abs((ny - y) * right);
      if (id === here || ahead <= 0 || ahead + 2 * aside >= least || !shown(id)) continue;
      [best, least] = [id, ahead + 2 * aside];
    }
    return best;
  };
  board.section.addEventListener("change", () => {
    if (here && !shown(here)) stand(walked.find(shown) || here);
  });
  const go = (id) => {
    stand(id);
    panning.reveal(...inDrawing(nodes[id]));
    board.mark(id).focus({ preventScroll: true });
  };

  svg.addEventListener("click", (event) => {
    const id = board.nodeAt(event.target);
    if (id) board.choose(id, "plan");
  });
  svg.addEventListener("focusin", (event) => {
    const id = board.nodeAt(event.target);
    if (id && walked.includes(id)) stand(id);
  });
  svg.addEventListener("keydown", (event) => {
    const id = event.target === svg ? null : board.nodeAt(event.target);
    if (event.key === "Escape") {
      if (board.chosen) board.choose(null, "plan");
      else svg.focus();
    } else if (!id) {
      return;
    } else if (WAYS[event.key]) {
      const to = next(WAYS[event.key]);
      if (to) go(to);
    } else if (event.key === "Enter" || event.key === " ") {
      board.choose(id, "keyboard");
    } else {
      return;
    }
    event.preventDefault();
  });
  board.addEventListener("choose", ({ detail: { id, by } }) => {
    if (!id) return;
    if (walked.includes(id)) stand(id);
    if (by !== "plan" && nodes[id].x != null) panning.reveal(...inDrawing(nodes[id]));
  });
  return { back: () => board.mark(here)?.focus({ preventScroll: true }) };
}
