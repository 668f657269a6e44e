// Zooms the plan with the wheel and moves it by dragging; a double click shows it whole again.
const plan = document.querySelector(".plan");
const whole = plan.getAttribute("viewBox");
const view = () => plan.getAttribute("viewBox").split(" ").map(Number);
const show = (box) => plan.setAttribute("viewBox", box.join(" "));
const inPlan = (event) => new DOMPoint(event.clientX, event.clientY)
  .matrixTransform(plan.getScreenCTM().inverse());
plan.addEventListener("wheel", (event) => {
  if (!event.ctrlKey && !event.altKey) return;
  event.preventDefault();
  const [x, y, width, height] = view(), at = inPlan(event);
  const by = Math.exp(event.deltaY / 400);
  show([at.x - (at.x - x) * by, at.y - (at.y - y) * by, width * by, height * by]);
}, { passive: false });
let held = null;
plan.addEventListener("pointerdown", (event) => {
  if (event.pointerType === "mouse") held = inPlan(event);
});
addEventListener("pointerup", () => { held = null; });
plan.addEventListener("pointermove", (event) => {
  if (!held) return;
  const [x, y, width, height] = view(), at = inPlan(event);
  show([x + held.x - at.x, y + held.y - at.y, width, height]);
});
plan.addEventListener("dblclick", () => plan.setAttribute("viewBox", whole));

// Fills in the timings where the browser lets a page read its neighbour: over http, not from
// disk. There run.json is shown as it is, in the frame below the table.
fetch("run.json").then((answer) => answer.json()).then((run) => {
  for (const cell of document.querySelectorAll("[data-seconds]")) {
    const seconds = (run.seconds || {})[cell.dataset.seconds];
    if (seconds !== undefined) cell.textContent = seconds.toFixed(3);
  }
  document.getElementById("run").remove();
}).catch(() => {
  for (const cell of document.querySelectorAll("[data-seconds]")) cell.textContent = "see below";
});
