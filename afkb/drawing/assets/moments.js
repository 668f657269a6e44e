// The slider over time: the plan as it was, what was predicted then, and where the robot stood.

import { calm } from "./dom.js";

const STEP_MS = 60;
const FAINTEST = 0.3;

export function letTimePass(board) {
  const { section, svg, nodes, times } = board;
  const row = section.querySelector(".time");
  const slider = row.querySelector("input"), told = row.querySelector("output");
  const line = row.querySelector(".event"), play = row.querySelector(".play");
  const happened = events(nodes);
  const moments = [...new Set([...times.way.map(([stamp]) => stamp),
    ...happened.map(({ stamp }) => stamp), times.start, times.end])].sort((a, b) => a - b);
  if (moments.length < 3) return;
  row.hidden = false;
  slider.max = moments.length;
  slider.value = moments.length;

  const robot = document.createElementNS(svg.namespaceURI, "circle");
  robot.setAttribute("class", "robot");
  robot.setAttribute("r", svg.querySelector(".place")?.getAttribute("r") || 10);
  const trail = svg.querySelector(".driven"), whole = trail?.getAttribute("points");

  function show() {
    const number = Number(slider.value), now = number >= moments.length;
    const stamp = now ? times.end : moments[number];
    svg.classList.toggle("then", !now);
    for (const [id, drawn] of board.elements) {
      const p = now ? 1 : existing(nodes[id], stamp);
      for (const part of drawn) draw(part, p, nodes, stamp, now);
    }
    told.textContent = now ? "now" : clock(stamp, times);
    const last = happened.findLast((event) => event.stamp <= stamp);
    line.textContent = now || !last ? "" : last.told;
    slider.setAttribute("aria-valuetext", `${told.textContent} ${line.textContent}`.trim());
    drive(stamp, now);
    board.dispatchEvent(new CustomEvent("moment", { detail: { stamp: now ? null : stamp } }));
  }

  function drive(stamp, now) {
    const way = times.way.filter(([at]) => at <= stamp);
    if (trail) {
      trail.setAttribute("points", now ? whole : way.map(([, x, y]) => `${x * 100},${-y * 100}`).join(" "));
    }
    if (now || !way.length) {
      robot.remove();
      return;
    }
    const [, x, y] = way.at(-1);
    robot.setAttribute("cx", x * 100);
    robot.setAttribute("cy", -y * 100);
    svg.append(robot);
  }

  let running = 0;
  const stop = () => {
    clearInterval(running);
    running = 0;
    play.setAttribute("aria-label", "Play");
    play.firstElementChild.textContent = "▶";
  };
  play.addEventListener("click", () => {
    if (running) {
      stop();
      return;
    }
    if (Number(slider.value) >= moments.length) slider.value = 0;
    play.setAttribute("aria-label", "Pause");
    play.firstElementChild.textContent = "❚❚";
    running = setInterval(() => {
      slider.value = Number(slider.value) + 1;
      show();
      if (Number(slider.value) >= moments.length) stop();
    }, calm() ? 10 * STEP_MS : STEP_MS);
  });
  slider.addEventListener("input", () => {
    stop();
    show();
  });
  show();
}

// The probability that a node existed by what was known then; 0 where nothing was known of it.
export function existing(facts, stamp) {
  if (!facts) return 1;
  if (facts.first_seen > stamp || facts.ended <= stamp) return 0;
  const steps = facts.steps || [];
  const last = steps.findLast((step) => step.stamp <= stamp);
  if (last) return last.after;
  return steps.length ? steps[0].before ?? steps[0].after : facts.existence ?? 1;
}

// What does not change from one moment to the next is left alone: most does not.
function draw(part, p, nodes, stamp, now) {
  const ends = part.dataset.ends?.split(" ") || [];
  const there = now || (p > 0 && ends.every((id) => existing(nodes[id], stamp) > 0));
  const faint = now || p > 0.99 ? "" : (FAINTEST + (1 - FAINTEST) * p).toFixed(2);
  if (part.classList.contains("not-yet") === there) part.classList.toggle("not-yet", !there);
  if (part.style.opacity !== faint) part.style.opacity = faint;
}

// What happened, in order: things seen and predicted first, and what came of predictions.
function events(nodes) {
  const found = [];
  for (const [id, facts] of Object.entries(nodes)) {
    if (facts.first_seen == null || facts.kind === "Bound") continue;
    const seen = facts.kind === "RobotPlace" ? `${id}: the robot takes this for a new place`
      : facts.kind === "ObservedEntity" ? `${id} is seen for the first time` : `${id} is predicted`;
    found.push({ stamp: facts.first_seen, told: seen });
    if (facts.ended != null) {
      const became = facts.seen_as ? `, seen as ${facts.seen_as}` : "";
      found.push({ stamp: facts.ended, told: `${id} is ${facts.state.toLowerCase()}${became}` });
    }
  }
  return found.sort((a, b) => a.stamp - b.stamp);
}

function clock(stamp, { start, visits }) {
  const number = visits.findLastIndex(([begin]) => begin <= stamp);
  if (visits.length < 2 || number < 0) return `${(stamp - start).toFixed(1)} s`;
  return `visit ${number + 1}, ${(stamp - visits[number][0]).toFixed(1)} s`;
}
