"""One gap as views have shown it: where its jambs are, and from how many places it was seen."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection

Array = NDArray[np.float64]

SAME_M, SAME_RAD = 0.35, math.radians(35.0)
"""Gaps whose middles lie this near, turned by no more, are one: jambs seen at a slant are uncertain
by the thickness of a wall."""
APART_M = 0.25
"""A view from nearer to an earlier one shows nothing new."""
EDGE_M = 0.2
"""Passages that begin or end this near to each other share a jamb as single views show it,"""
EDGE_OF_MAP_M = 0.1
"""and as the map does, to a cell: two doorways may lie at the corners of one wall's end."""
LINTELS_KEPT = 50


@dataclass(slots=True, eq=False)
class SeenGap:
    """Weighted sums over the views of one gap; jambs (2, 2) in the order of the first view's."""

    jambs: Array
    mass: float
    plan: list[float] = field(default_factory=list)
    eyes: list[list[float]] = field(default_factory=list)
    lintels: list[float] = field(default_factory=list)

    @property
    def jambs_xy(self) -> Array:
        """(2, 2) m, map frame: the mean of what the views show."""
        mean: Array = self.jambs / self.mass
        return mean

    @property
    def middle_xy(self) -> tuple[float, float]:
        """Halfway between the jambs, m; asked of every gap in every view, hence no array."""
        (ax, ay), (bx, by) = self.jambs.tolist()
        return (ax + bx) / (2 * self.mass), (ay + by) / (2 * self.mass)

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
        eye = eye_xy.tolist()
        near = [k for k, e in enumerate(self.eyes) if math.dist(e, eye) < APART_M]
        if near:
            self.plan[near[0]] = max(self.plan[near[0]], plan)
        else:
            self.eyes.append(eye)
            self.plan.append(plan)

    @property
    def lintel_m(self) -> float:
        """Height of its lintel, m; NaN where none was seen."""
        return float(np.median(self.lintels)) if self.lintels else math.nan


def jambs_of(detection: Detection) -> Array:
    """(2, 2) m: ends of an opening's width, from its box."""
    x, y, _ = detection.box.center_xyz
    half = detection.box.size_xyz[1] / 2
    across = np.array([-math.sin(detection.box.yaw), math.cos(detection.box.yaw)])
    return np.array([x, y]) + np.outer([-half, half], across)


def turn_between(first: Array, second: Array) -> float:
    """Angle between two lines (2, 2), rad."""
    a, b = first[1] - first[0], second[1] - second[0]
    return math.atan2(abs(a[0] * b[1] - a[1] * b[0]), abs(float(a @ b)))


def are_apart(first: Array, second: Array, edge_m: float = EDGE_M) -> bool:
    """Whether two passages share no jamb, and neither has its middle in the other."""
    shared = min(
        float(np.linalg.norm(first - second, axis=1).min()),
        float(np.linalg.norm(first - second[::-1], axis=1).min()),
    )
    off = float(np.linalg.norm(first.mean(axis=0) - second.mean(axis=0)))
    widest = max(float(np.linalg.norm(j[1] - j[0])) for j in (first, second))
    return shared > edge_m and off > widest / 2
