// Pans and zooms the plan: mouse, touch, keyboard and buttons.

const LEAST_WIDTH = 30;
const MOST_TIMES_WHOLE = 4;
const CLICK_WITHIN_PX = 4;
const KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

// While the plan is moved it is only shifted and stretched as a picture, which costs nothing
// however much is on it; when it has stood still so long it is drawn sharp again.
const SHARP_AFTER_MS = 140;
const SLOW_MS = 1000;

export class Panning {
  // wheel: "always" zooms by the wheel, "ctrl" leaves the plain wheel to the page.
  constructor(board, wheel) {
    this.svg = board.svg;
    this.frame = board.section.querySelector(".canvas");
    this.sheet = board.section.querySelector(".sheet");
    this.whole = this.svg.getAttribute("viewBox").split(" ").map(Number);
    this.view = [...this.whole];
    this.drawn = [...this.whole];
    this.fingers = new Map();
    this.svg.setAttribute("tabindex", "0");
    this.frame.classList.add(wheel === "always" ? "takes-touch" : "leaves-touch");
    this.frame.addEventListener("wheel", (event) => this.#turned(event, wheel), { passive: false });
    this.frame.addEventListener("dblclick", (event) => {
      if (!board.nodeAt(event.target) && !event.target.closest("button")) this.showWhole();
    });
    for (const [name, does] of [["pointerdown", "down"], ["pointermove", "move"],
      ["pointerup", "up"], ["pointercancel", "up"]]) {
      this.frame.addEventListener(name, (event) => this[does](event));
    }
    this.svg.addEventListener("keydown", (event) => this.#pressed(event));
    const buttons = board.section.querySelector(".zoom");
    buttons.hidden = false;
    buttons.addEventListener("click", (event) => {
      const wanted = event.target.closest("button")?.dataset.zoom;
      if (wanted) this.#act({ in: "+", out: "-", whole: "0" }[wanted]);
    });
  }

  show(view) {
    this.view = view;
    const [now, before] = [this.#placed(view), this.#placed(this.drawn)];
    const [dx, dy] = [(before.x - now.x) / now.perPixel, (before.y - now.y) / now.perPixel];
    const times = before.perPixel / now.perPixel;
    this.sheet.style.transform = `translate(${dx}px, ${dy}px) scale(${times})`;
    clearTimeout(this.waiting);
    const since = performance.now() - (this.moved ?? -Infinity);
    this.moved = performance.now();
    // Where frames are slow, moves come seldom: drawing in between would make them slower still.
    const wait = since < SLOW_MS ? Math.max(SHARP_AFTER_MS, 2.5 * since) : SHARP_AFTER_MS;
    this.waiting = setTimeout(() => this.#sharpen(), wait);
  }

  #sharpen() {
    this.drawn = this.view;
    this.sheet.style.transform = "";
    this.svg.setAttribute("viewBox", this.view.map((v) => Math.round(v * 100) / 100).join(" "));
    // Marks and names grow more slowly than the plan, so that what stands close comes apart.
    const share = Math.min(1, this.view[2] / this.whole[2]);
    this.svg.style.setProperty("--mark", Math.round(1000 * share ** 0.6) / 1000);
    this.svg.classList.toggle("zoomed", share < 1);
  }

  // The middle of a view, and drawing units per pixel: it is fitted into the frame, centred.
  #placed([x, y, width, height]) {
    const { clientWidth, clientHeight } = this.frame;
    const perPixel = Math.max(width / clientWidth, height / clientHeight);
    return { x: x + width / 2, y: y + height / 2, perPixel };
  }

  showWhole() {
    this.show([...this.whole]);
  }

  zoom(by, at = null) {
    const [x, y, width, height] = this.view;
    const most = MOST_TIMES_WHOLE * this.whole[2];
    const times = Math.min(most, Math.max(LEAST_WIDTH, width * by)) / width;
    const [cx, cy] = at || [x + width / 2, y + height / 2];
    this.show([cx - (cx - x) * times, cy - (cy - y) * times, width * times, height * times]);
  }

  pan(dx, dy) {
    const [x, y, width, height] = this.view;
    this.show([x + dx, y + dy, width, height]);
  }

  // Moves the plan just so far that a point of the drawing is well inside.
  reveal(px, py) {
    const [x, y, width, height] = this.view;
    const inside = (v, low, size) => v > low + 0.08 * size && v < low + 0.92 * size;
    if (inside(px, x, width) && inside(py, y, height)) return;
    this.show([px - width / 2, py - height / 2, width, height]);
  }

  inPlan(clientX, clientY) {
    const { left, top, width, height } = this.frame.getBoundingClientRect();
    const { x, y, perPixel } = this.#placed(this.view);
    return [x + (clientX - left - width / 2) * perPixel, y + (clientY - top - height / 2) * perPixel];
  }

  #turned(event, wheel) {
    if (wheel !== "always" && !event.ctrlKey && !event.altKey) return;
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1;
    this.zoom(Math.exp((event.deltaY * lines) / 400), this.inPlan(event.clientX, event.clientY));
  }

  down(event) {
    if ((event.pointerType === "mouse" && event.button !== 0) || event.target.closest("button")) return;
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
    this.start = [event.clientX, event.clientY];
  }

  move(event) {
    const before = this.fingers.get(event.pointerId);
    if (!before) return;
    const far = Math.hypot(event.clientX - this.start[0], event.clientY - this.start[1]);
    if (far < CLICK_WITHIN_PX && this.fingers.size === 1) return;
    this.frame.setPointerCapture(event.pointerId);
    const others = [...this.fingers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    const { perPixel } = this.#placed(this.view);
    const now = [event.clientX, event.clientY];
    const share = 1 / this.fingers.size;
    this.pan((before[0] - now[0]) * perPixel * share, (before[1] - now[1]) * perPixel * share);
    if (others.length) {
      const apart = (at) => Math.max(1, Math.hypot(at[0] - others[0][0], at[1] - others[0][1]));
      const middle = [(now[0] + others[0][0]) / 2, (now[1] + others[0][1]) / 2];
      this.zoom(apart(before) / apart(now), this.inPlan(...middle));
    }
    this.fingers.set(event.pointerId, now);
  }

  up(event) {
    this.fingers.delete(event.pointerId);
  }

  #pressed(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const onPlan = event.target === this.svg;
    if (KEYS[event.key] ? onPlan && this.#step(...KEYS[event.key]) : this.#act(event.key)) {
      event.preventDefault();
    }
  }

  #step(right, down) {
    this.pan(0.1 * right * this.view[2], 0.1 * down * this.view[3]);
    return true;
  }

  #act(key) {
    if (key === "+" || key === "=") this.zoom(1 / 1.3);
    else if (key === "-") this.zoom(1.3);
    else if (key === "0") this.showWhole();
    else return false;
    return true;
  }
}
