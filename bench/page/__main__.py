"""Frame times of the page at many nodes: moving, zooming, time, search, in headless Chromium.

    python -m bench.page [--nodes 2000] [--frames 60] [--json OUT]

Draws a made-up map of so many things (seeded, so the same in every run) as report.html, opens it
without a graphics card, and acts once a frame. A frame's time is from one animation frame to the
next, on whatever else the machine does; the processor's time, of all of the browser's processes,
is nearly free of that. Below 17 ms a screen of 60 Hz misses no frame.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import sys
import tempfile
from pathlib import Path

from afkb_report.exporter import page
from bench.page.large_map import large_map

_QUIET = ("--no-sandbox", "--disable-gpu", "--disable-background-networking",
          "--disable-component-update", "--disable-sync")  # fmt: skip
_KEY = "i => plan.dispatchEvent(new KeyboardEvent('keydown', {{bubbles: true, key: {}}}))"
ACTS = {
    "nothing": "i => 0",
    "move": _KEY.format("i % 2 ? 'ArrowLeft' : 'ArrowRight'"),
    "zoom": _KEY.format("i % 20 < 10 ? '+' : '-'"),
    "time": "i => { moment.value = i; moment.dispatchEvent(new Event('input')); }",
    "search": "i => { search.value = `thing-${i}`; search.dispatchEvent(new Event('input')); }",
}
"""What is done in each frame `i`, as JavaScript."""
_FRAMES = """([act, frames]) => new Promise((done) => {
  const plan = document.querySelector(".plan"), doing = eval(act), times = [];
  let number = 0, last = null;
  requestAnimationFrame(function step(now) {
    if (last !== null) times.push(now - last);
    last = now;
    if (number++ === frames) { done(times); return; }
    doing(number);
    requestAnimationFrame(step);
  });
})"""
_SETTLED_MS = 1500
_OPENED_WITHIN_MS = 300_000


def main() -> int:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--nodes", type=int, default=2000)
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--json", type=Path, metavar="OUT")
    args = parser.parse_args()
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        sys.stderr.write("error: no Chromium; see scripts/chromium.sh\n")
        return 1
    result = measure(args.nodes, args.frames, chromium)
    if args.json:
        args.json.write_text(json.dumps(result, indent=1), encoding="utf-8")
    sys.stdout.write(
        f"{args.nodes} nodes, {result['megabytes']:.1f} MB, load {result['load']:.1f}\n"
    )
    sys.stdout.write(f"{'':8} median ms  p95 ms  processor ms\n")
    for name, told in result["acts"].items():
        row = f"{told['median_ms']:9.0f} {told['p95_ms']:7.0f} {told['processor_ms']:13.0f}"
        sys.stdout.write(f"{name:8} {row}\n")
    return 0


def measure(nodes: int, frames: int, chromium: str) -> dict[str, object]:
    """Per act the frame's time and the processor's time a frame, ms; `load`: of the machine."""
    from playwright.sync_api import sync_playwright

    text = page(large_map(nodes), {})
    acts: dict[str, dict[str, float]] = {}
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        report = Path(folder, "report.html")
        report.write_text(text, encoding="utf-8")
        browser = playwright.chromium.launch(executable_path=chromium, args=_QUIET)
        shown = browser.new_page(viewport={"width": 1280, "height": 1000})
        shown.goto(report.as_uri(), timeout=_OPENED_WITHIN_MS)
        for name, act in ACTS.items():
            shown.wait_for_timeout(_SETTLED_MS)
            before = processor_ms()
            times = sorted(shown.evaluate(_FRAMES, [act, frames]))
            acts[name] = {
                "median_ms": statistics.median(times),
                "p95_ms": times[int(0.95 * len(times))],
                "processor_ms": (processor_ms() - before) / frames,
            }
        browser.close()
    megabytes = len(text.encode()) / 1e6
    return {"nodes": nodes, "megabytes": megabytes, "load": os.getloadavg()[0], "acts": acts}


def processor_ms() -> float:
    """Processor time of this process's living descendants, ms (Linux: /proc)."""
    parents: dict[int, tuple[int, int]] = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            parents[int(entry.name)] = int(fields[1]), int(fields[11]) + int(fields[12])
    ticks = sum(used for process, (_, used) in parents.items() if _descends(process, parents))
    return 1000.0 * ticks / os.sysconf("SC_CLK_TCK")


def _descends(process: int, parents: dict[int, tuple[int, int]]) -> bool:
    while process in parents:
        process = parents[process][0]
        if process == os.getpid():
            return True
    return False


if __name__ == "__main__":
    raise SystemExit(main())
