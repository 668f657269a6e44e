"""Doorways as views show them, merged into one a place, and held against what is tall there."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OccupancyGrid, View
from afkb_mapping.box_index import BoxIndex
from afkb_mapping.doorways.gaps import (
    EDGE_M,
    EDGE_OF_MAP_M,
    SAME_M,
    SAME_RAD,
    SeenGap,
    are_apart,
    jambs_of,
    turn_between,
)
from afkb_mapping.doorways.judge import DoorwayJudge
from afkb_mapping.doorways.narrows import gaps_of_map
from afkb_mapping.panorama import panorama_of
from afkb_mapping.structure import PASSAGE, is_passage
from afkb_mapping.trapezoids import Limits, parameters
from afkb_mapping.upright_cells import UprightCells

if TYPE_CHECKING:
    from afkb.knowledge import AfNet

Array = NDArray[np.float64]

WIDTH_M: Limits = (0.55, 0.7, 1.8, 2.5)
"""How wide passages are, where nobody tells what the ontology at hand states."""
REPEAT = 0.4
"""P(a gap by chance is seen again from elsewhere): so much is left of the doubt by each view."""
LIKELY = 0.5


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


class DoorwayMerger:
    """Collects what views show of passages; memory grows with the place and not with time.

    A laser sees both jambs of a doorway at once, a depth camera hardly ever: from depth alone,
    doorways are sought in the map that the views make together.
    """

    def __init__(self, width_m: Limits = WIDTH_M) -> None:
        self._width_m = width_m
        self._gaps: list[SeenGap] = []
        self._by_middle: BoxIndex[SeenGap] = BoxIndex()
        self._upright = UprightCells()
        self._has_scans = False

    def add(self, view: View, detections: Sequence[Detection]) -> None:
        """Take in one placed view's detections of passages."""
        panorama = panorama_of(view)
        if panorama is not None:
            self._upright.add(panorama)
        self._has_scans |= view.scan is not None
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
            known = SeenGap(plan**2 * jambs, plan**2)
            self._gaps.append(known)
            known.see(plan, lintel, eye_xy)
        else:
            known.absorb(jambs, plan, lintel, eye_xy)
        middle = np.array(known.middle_xy)
        self._by_middle.put(known, middle, middle)

    def _known(self, jambs_xy: Array) -> SeenGap | None:
        (ax, ay), (bx, by) = jambs_xy.tolist()
        middle, best, least = ((ax + bx) / 2, (ay + by) / 2), None, SAME_M
        at = np.array(middle)
        for gap in self._by_middle.near(at - SAME_M, at + SAME_M):
            off = math.dist(gap.middle_xy, middle)
            if off < least and turn_between(gap.jambs_xy, jambs_xy) < SAME_RAD:
                best, least = gap, off
        return best

    def doorways(self, grid: OccupancyGrid, at_least: float = LIKELY) -> list[SeenDoorway]:
        """The likely ones, likeliest first; of those that share a jamb, the likeliest."""
        judge = self.judge(grid)
        found = list(self._of_scans(judge) if self._has_scans else self._of_map(judge, grid))
        edge = EDGE_M if self._has_scans else EDGE_OF_MAP_M
        kept: list[tuple[Array, SeenDoorway]] = []
        for jambs, seen in sorted(found, key=lambda f: -f[1].probability):
            if seen.probability >= at_least and all(are_apart(jambs, k, edge) for k, _ in kept):
                kept.append((jambs, seen))
        return [seen for _, seen in kept]

    def judge(self, grid: OccupancyGrid) -> DoorwayJudge:
        """What holds a gap in the grid against all that views have shown to be tall or low."""
        return DoorwayJudge(self._upright, grid)

    def _of_scans(self, judge: DoorwayJudge) -> Iterator[tuple[Array, SeenDoorway]]:
        """Gaps that single views have shown."""
        for gap in self._gaps:
            views = len(gap.eyes)
            p = judge.doorway(gap.jambs_xy, max(gap.plan) * (1 - REPEAT**views))
            yield gap.jambs_xy, _seen(gap.jambs_xy, p, views, gap.lintel_m)

    def _of_map(
        self, judge: DoorwayJudge, grid: OccupancyGrid
    ) -> Iterator[tuple[Array, SeenDoorway]]:
        """Gaps in what all views together have shown."""
        for jambs, plan in gaps_of_map(judge.free, judge.standing, grid, self._width_m):
            views = min(self._upright.views(jamb) for jamb in jambs)
            p = judge.doorway_of_map(jambs, plan * (1 - REPEAT**views))
            known = self._known(jambs)
            yield jambs, _seen(jambs, p, views, known.lintel_m if known else math.nan)


def passage_width(knowledge_base: AfNet) -> Limits:
    """Trapezoid of how wide passages are, m, as the ontology at hand states it."""
    return parameters(knowledge_base, PASSAGE).get("width_m", WIDTH_M)


def _seen(jambs_xy: Array, p: float, views: int, lintel_m: float) -> SeenDoorway:
    x, y = jambs_xy.mean(axis=0)
    along = jambs_xy[1] - jambs_xy[0]
    yaw = math.atan2(-along[0], along[1])
    return SeenDoorway(float(x), float(y), yaw, float(np.linalg.norm(along)), p, views, lintel_m)
