"""What detectors say of a recording, view by view, at its true poses."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb_mapping.calibration import CalibratedDetector

MARGIN_M = 0.05
"""A thing's box reaches this far beside it: noise at the end of a room, and two depth steps."""
CLAIMED = 0.5
"""A detection claims what it affords with at least this probability."""
SAME_STAMP_S = 0.05


@dataclass
class Run:
    """Every detection of a recording, by view, and what each detector took.

    `scored` are the same detections, in the same order, before their plugin's table made
    probabilities of their scores; `stamps` the views' times, s.
    """

    views: list[tuple[int, list[Detection]]] = field(default_factory=list)
    scored: list[list[Detection]] = field(default_factory=list)
    stamps: list[float] = field(default_factory=list)
    milliseconds: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))

    def of(self, feature: str, at_least: float = CLAIMED) -> Iterator[tuple[int, Detection]]:
        """Claims of a feature, with the view they were made in."""
        for index, detections in self.views:
            for detection in detections:
                if detection.affords(feature, at_least):
                    yield index, detection


def run_detectors(views: Iterable[View], detectors: Sequence[Any]) -> Run:
    """What all detectors say of the views, coarse before fine, as a run asks them."""
    run = Run()
    for view in views:
        found: list[Detection] = []
        scored: list[Detection] = []
        for stage in sorted({d.stage for d in detectors}):
            earlier = tuple(found)
            for detector in (d for d in detectors if d.stage == stage):
                start = time.thread_time()
                new, stated = _scored_and_stated(detector, view, earlier)
                run.milliseconds[detector.name].append(1e3 * (time.thread_time() - start))
                scored += new
                found += stated
        run.views.append((view.index, found))
        run.scored.append(scored)
        run.stamps.append(view.stamp)
    return run


def _scored_and_stated(
    detector: Any, view: View, earlier: tuple[Detection, ...]
) -> tuple[list[Detection], list[Detection]]:
    if not isinstance(detector, CalibratedDetector):
        found = list(detector.detect(view, earlier))
        return found, found
    scored = list(detector.scorer.detect(view, earlier))
    return scored, [detector.calibrate(d) for d in scored]


def placed_views(views: Iterable[object], truth: dict[str, Any]) -> Iterator[View]:
    """The views at their true poses, matched by stamp."""
    stamps = np.array([v["stamp"] for v in truth["views"]])
    for view in views:
        if not isinstance(view, View) or view.depth_m is None:
            continue
        nearest = int(np.abs(stamps - view.stamp).argmin())
        if abs(stamps[nearest] - view.stamp) > SAME_STAMP_S:
            continue
        pose = truth["views"][nearest]
        yield replace(view, T_map_base=_planar(pose["x"], pose["y"], pose["yaw"]))


def _planar(x: float, y: float, yaw: float) -> NDArray[np.float64]:
    T = np.eye(4)
    T[:2, :2] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
    T[:2, 3] = x, y
    return T


def inside(thing: dict[str, Any], xy: NDArray[np.float64]) -> NDArray[np.bool_]:
    low, high = np.array(thing["min"][:2]) - MARGIN_M, np.array(thing["max"][:2]) + MARGIN_M
    result: NDArray[np.bool_] = np.all((xy >= low) & (xy <= high), axis=1)
    return result


def described(index: int, d: Detection) -> dict[str, Any]:
    return {
        "view": index,
        "p": {k: round(v, 2) for k, v in d.affordances.items()},
        "position": [round(float(v), 2) for v in d.position_xyz],
        "size": [round(v, 2) for v in d.box.size_xyz],
        "pixels": d.n_pixels,
        "range": round(d.range_m, 2),
        "measures": {k: round(v, 3) for k, v in d.measures.items()},
    }
