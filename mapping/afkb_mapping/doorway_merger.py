"""Doorways as views show them, merged into one a place, and held against what is tall there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OccupancyGrid, View
from afkb_mapping.detour import room_to_room, way_free
from afkb_mapping.panorama import panorama_of
from afkb_mapping.structure import PASSAGE, is_passage
from afkb_mapping.upright_cells import UprightCells

Array = NDArray[np.float64]

SAME_M, SAME_RAD = 0.35, math.radians(35.0)
"""Gaps whose middles lie this near, turned by no more, are one: jambs seen at a slant are uncertain
by the thickness of a wall."""
APART_M = 0.25
"""A view from nearer to an earlier one shows nothing new."""
UNKNOWN_HEIGHT = 0.6
"""P(wall | straight jamb whose height no view has shown)."""
TALL_SHARE = (0.1, 0.4)
"""One looks over a cabinet from everywhere, past the edge of a wall from here and there."""
LOW_JAMB = 0.6
"""P(doorway | one of its jambs is low): a cabinet that stands before the wall's end."""
OBSTRUCTED = (0.1, 0.4)
"""Share of the line between the jambs, on which something stands: a door leaf, or a shelf."""
KNEE_JAMB, MOSTLY = 0.2, 0.5
"""The same of what is mostly knee-high, as a bed or a seat is."""
FAINT = 0.05
"""Below this no grid makes it likely."""
REPEAT = 0.4
"""P(a gap by chance is seen again from elsewhere): so much is left of the doubt by each view."""
JAMB_REACH_M = 0.15
"""What stands this near to where a jamb ends is the jamb."""
ACROSS_STEP_M = 0.1
LIKELY = 0.5
EDGE_M = 0.2
"""Passages that begin or end this near to each other share a jamb as the views show it."""


@dataclass(frozen=True, slots=True)
class SeenDoorway:
    """A passage that views have shown: middle (m), direction through it (rad), width (m).

    `lintel_m`: NaN where none was seen. `views`: that showed it, from different places.
    """

    x: float
    y: float
    yaw: float
    width: float
    probability: float
    views: int
    lintel_m: float


@dataclass(slots=True)
class _Gap:
    """Weighted sums over the views of one gap; jambs (2, 2) in the order of the first view's."""

    jambs: Array
    mass: float
    plan: list[float] = field(default_factory=list)
    eyes: list[Array] = field(default_factory=list)
    lintels: list[float] = field(default_factory=list)

    @property
    def jambs_xy(self) -> Array:
        mean: Array = self.jambs / self.mass
        return mean

    def absorb(self, jambs_xy: Array, plan: float, lintel_m: float | None, eye_xy: Array) -> None:
        """Take in one more view of it."""
        swapped = jambs_xy[::-1]
        off = [np.linalg.norm(j - self.jambs_xy) for j in (jambs_xy, swapped)]
        self.jambs = self.jambs + plan**2 * (jambs_xy if off[0] <= off[1] else swapped)
        self.mass += plan**2
        self.see(plan, lintel_m, eye_xy)

    def see(self, plan: float, lintel_m: float | None, eye_xy: Array) -> None:
        """Count the view, unless it is from where an earlier one was."""
        if lintel_m is not None:
            self.lintels = [*self.lintels, lintel_m][-LINTELS_KEPT:]
        near = [k for k, e in enumerate(self.eyes) if np.linalg.norm(e - eye_xy) < APART_M]
        if near:
            self.plan[near[0]] = max(self.plan[near[0]], plan)
        else:
            self.eyes.append(eye_xy)
            self.plan.append(plan)


LINTELS_KEPT = 50


class DoorwayMerger:
    """Collects what views show of passages; memory grows with the place and not with time."""

    def __init__(self) -> None:
        self._gaps: list[_Gap] = []
        self._upright = UprightCells()

    def add(self, view: View, detections: Sequence[Detection]) -> None:
        """Take in one placed view's detections of passages."""
        panorama = panorama_of(view)
        if panorama is not None:
            self._upright.add(panorama)
        eye = (view.T_map_laser if view.scan is not None else view.T_map_camera)[:2, 3]
        for detection in detections:
            if is_passage(detection):
                self._take_in(detection, eye)

    def _take_in(self, detection: Detection, eye_xy: Array) -> None:
        jambs = jambs_of(detection)
        plan = detection.measures.get("plan", detection.affordances[PASSAGE])
        lintel = detection.measures.get("lintel_height")
        known = self._known(jambs)
        if known is None:
            known = _Gap(plan**2 * jambs, plan**2)
            self._gaps.append(known)
            known.see(plan, lintel, eye_xy)
        else:
            known.absorb(jambs, plan, lintel, eye_xy)

    def _known(self, jambs_xy: Array) -> _Gap | None:
        best, least = None, SAME_M
        for gap in self._gaps:
            off = float(np.linalg.norm(gap.jambs_xy.mean(axis=0) - jambs_xy.mean(axis=0)))
            if off < least and _turn(gap.jambs_xy, jambs_xy) < SAME_RAD:
                best, least = gap, off
        return best

    def doorways(self, grid: OccupancyGrid, at_least: float = LIKELY) -> list[SeenDoorway]:
        """The likely ones, likeliest first; of those that share a jamb, the likeliest."""
        free = way_free(grid, self._upright.mark(grid))
        judged = [self._judged(gap, free, grid) for gap in self._gaps]
        order = sorted(range(len(judged)), key=lambda k: (-judged[k].probability, k))
        kept: list[int] = []
        for k in order:
            if judged[k].probability >= at_least and all(
                _are_apart(self._gaps[k].jambs_xy, self._gaps[other].jambs_xy) for other in kept
            ):
                kept.append(k)
        return [judged[k] for k in kept]

    def _judged(self, gap: _Gap, free: NDArray[np.bool_], grid: OccupancyGrid) -> SeenDoorway:
        jambs = gap.jambs_xy
        along = jambs[1] - jambs[0]
        width = float(np.linalg.norm(along))
        views = len(gap.eyes)
        p = max(gap.plan) * (1 - REPEAT**views)
        for jamb in jambs:
            p *= self._is_jamb(jamb[None])
        inner = np.arange(JAMB_REACH_M, width - JAMB_REACH_M, ACROSS_STEP_M)
        if len(inner):
            stands = self._upright.stands_on(jambs[0] + np.outer(inner / width, along))
            p *= 1 - _ramp(stands, *OBSTRUCTED)
        p *= room_to_room(jambs, free, grid) if p >= FAINT else 0.0
        x, y = jambs.mean(axis=0)
        lintel = float(np.median(gap.lintels)) if gap.lintels else math.nan
        yaw = math.atan2(-along[0], along[1])
        return SeenDoorway(float(x), float(y), yaw, width, p, views, lintel)

    def _is_jamb(self, jamb_xy: Array) -> float:
        """Probability that what stands at a point (1, 2), m, ends or hides the end of a wall."""
        tall = self._upright.tall(jamb_xy, JAMB_REACH_M)
        if math.isnan(tall):
            return UNKNOWN_HEIGHT
        knee = self._upright.knee_high(jamb_xy, JAMB_REACH_M)
        return _ramp(tall, *TALL_SHARE, KNEE_JAMB if knee > MOSTLY else LOW_JAMB)


def _ramp(value: float, low: float, high: float, least: float = 0.0) -> float:
    """From `least` at or below `low` to 1 at or above `high`."""
    return least + (1 - least) * min(1.0, max(0.0, (value - low) / (high - low)))


def jambs_of(detection: Detection) -> Array:
    """(2, 2) m: ends of an opening's width, from its box."""
    x, y, _ = detection.box.center_xyz
    half = detection.box.size_xyz[1] / 2
    across = np.array([-math.sin(detection.box.yaw), math.cos(detection.box.yaw)])
    return np.array([x, y]) + np.outer([-half, half], across)


def _turn(first: Array, second: Array) -> float:
    """Angle between two lines (2, 2), rad."""
    a, b = first[1] - first[0], second[1] - second[0]
    return math.atan2(abs(a[0] * b[1] - a[1] * b[0]), abs(float(a @ b)))


def _are_apart(first: Array, second: Array) -> bool:
    """Whether two passages share no jamb, and neither has its middle in the other."""
    shared = min(
        float(np.linalg.norm(first - second, axis=1).min()),
        float(np.linalg.norm(first - second[::-1], axis=1).min()),
    )
    off = float(np.linalg.norm(first.mean(axis=0) - second.mean(axis=0)))
    widest = max(float(np.linalg.norm(j[1] - j[0])) for j in (first, second))
    return shared > EDGE_M and off > widest / 2
