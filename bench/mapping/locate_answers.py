"""What became of answers to "where was this seen?": right, wrong or lost."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binomtest

from afkb.flow import View
from afkb_mapping.geometry import yaw_of

RIGHT_M, RIGHT_RAD = 0.25, math.radians(10)
NONSENSE = 0.6
"""Share of the beams that are replaced by random ranges."""
SEED = 1
NEAR_M = (0.05, 0.1, 0.2, 0.5, 1.0, math.inf)
"""Distances to the nearest mapped view, by which answers are grouped."""
BECAME = ("right", "wrong", "lost")

Array = NDArray[np.float64]
Sense = Callable[[View, np.random.Generator], View]
Told = tuple[bool, float, float, float]
Ask = Callable[[Sequence[View]], Told]
"""Whether lost, x, y (m) and yaw (rad), from some views."""


def laser(view: View, _: np.random.Generator) -> View:
    """What a laser alone senses."""
    return replace(view, depth_m=None, camera=None)


def nonsense(view: View, rng: np.random.Generator) -> View:
    """A laser alone, most of whose beams end anywhere."""
    assert view.scan is not None
    ranges = view.scan.ranges_m.copy()
    wrong = rng.random(len(ranges)) < NONSENSE
    ranges[wrong] = rng.uniform(0.3, 6.0, int(wrong.sum()))
    return replace(laser(view, rng), scan=replace(view.scan, ranges_m=ranges))


def depth(view: View, _: np.random.Generator) -> View:
    """What a depth camera alone senses."""
    return replace(view, scan=None)


def everything(view: View, _: np.random.Generator) -> View:
    """Laser and camera."""
    return view


SENSES: dict[str, tuple[Sense, int]] = {
    "depth": (depth, 1),
    "depth, three views": (depth, 3),
    "laser": (laser, 1),
    "laser, 60 % of the beams nonsense": (nonsense, 1),
    "laser and depth": (everything, 1),
}
"""What is sensed of each of how many consecutive views."""


def answers(
    ask: Ask,
    views: Sequence[View],
    sense: Sense,
    together: int,
    stride: int,
    seconds: float = math.inf,
) -> list[dict[str, Any]]:
    """Each answer: what became of it, its error, the CPU time, and where it was asked.

    No question is begun after `seconds` of wall time.
    """
    rng = np.random.default_rng(SEED)
    begun = time.perf_counter()
    found = []
    for end in range(together - 1, len(views), stride):
        if time.perf_counter() - begun > seconds:
            break
        question = [sense(v, rng) for v in views[end - together + 1 : end + 1]]
        start = time.process_time()
        told = ask(question)
        took = time.process_time() - start
        found.append({**_judged(told, views[end]), "seconds": took})
    return found


def _judged(told: Told, view: View) -> dict[str, Any]:
    lost, x, y, yaw = told
    T = view.T_map_base
    assert T is not None
    off = math.hypot(x - T[0, 3], y - T[1, 3])
    turned = abs(math.remainder(yaw - yaw_of(T), math.tau)) if math.isfinite(yaw) else math.pi
    is_right = off <= RIGHT_M and turned <= RIGHT_RAD
    became = "lost" if lost else "right" if is_right else "wrong"
    return {"became": became, "best_is_right": is_right, "off": off, "xy": T[:2, 3]}


def shares(answered: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Of right, wrong and lost with their 95 % Wilson intervals; median error and CPU time."""
    n = len(answered)
    found: dict[str, Any] = {"asked": n}
    for what in BECAME:
        k = sum(a["became"] == what for a in answered)
        found[what] = k / n if n else None
        interval = binomtest(k, n).proportion_ci(method="wilson") if n else (None, None)
        found[f"{what}_95"] = [None if end is None else float(end) for end in interval]
    found["best_is_right"] = sum(a["best_is_right"] for a in answered) / n if n else None
    off = [a["off"] for a in answered if a["became"] == "right"]
    found["error_m"] = float(np.median(off)) if off else None
    found["seconds"] = float(np.median([a["seconds"] for a in answered])) if n else None
    return found


def by_distance(answered: Sequence[dict[str, Any]], mapped_xy: Array) -> dict[str, Any]:
    """`shares` of answers by how far the nearest of some places (N, 2), m, is."""
    apart = [float(np.linalg.norm(mapped_xy - a["xy"], axis=1).min()) for a in answered]
    groups: dict[str, Any] = {}
    low = 0.0
    for high in NEAR_M:
        within = [a for a, d in zip(answered, apart, strict=True) if low <= d < high]
        groups[f"{low:.2f} to {high:.2f} m"] = shares(within)
        low = high
    return groups


def lines(rows: dict[str, dict[str, Any]]) -> Iterator[str]:
    """A line for each row of `shares`."""
    for name, r in rows.items():
        if not r["asked"]:
            yield f"{name:36} none asked"
            continue
        cells = []
        for what in BECAME:
            low, high = r[f"{what}_95"]
            cells.append(f"{r[what]:5.3f} ({low:.2f} to {high:.2f})")
        off = "       –" if r["error_m"] is None else f"{r['error_m']:8.3f}"
        yield f"{name:36} {' '.join(cells)} {off} {r['seconds']:6.2f}   of {r['asked']}"


HEADER = f"{'right':>20} {'wrong':>20} {'lost':>20} error, m  CPU s"
