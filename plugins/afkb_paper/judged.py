"""A map beside the truth: where its frame lies in it, and how far off the robot was placed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.errors import SourceError
from afkb.flow import OrientedBox, TopologicalMap, TrueThing, TrueView, Truth
from afkb_mapping.geometry import T_from_xy_yaw, inverse, wrap_angle, yaw_of

Array = NDArray[np.float64]

MS = 1000
"""Views of the map and of the truth are paired by their stamps, to a millisecond."""


@dataclass(frozen=True, slots=True, eq=False)
class Judged:
    """A map with the truth of its recording, whose frame lies at `T_map_true` (4, 4) in the map's.

    The frames are laid on each other at the first view that both know, as there the map frame is
    fixed: what drifts later is the map's own error.
    """

    found: TopologicalMap
    truth: Truth
    T_map_true: Array

    @classmethod
    def of(cls, found: TopologicalMap, truth: Truth) -> Judged:
        """Raises `SourceError` where no view of the map is in the truth."""
        for row, view in _pairs(found, truth):
            T_true_base = T_from_xy_yaw(view.x, view.y, view.yaw)
            T_map_base = row[1:].reshape(4, 4)
            flat = T_from_xy_yaw(T_map_base[0, 3], T_map_base[1, 3], yaw_of(T_map_base))
            return cls(found, truth, flat @ inverse(T_true_base))
        raise SourceError("no view of the map has a stamp of the truth: is it of this recording?")

    def views(self) -> Iterator[tuple[TrueView, float, float]]:
        """The true views that were mapped, and how far off the robot was placed, m and rad."""
        turned = yaw_of(self.T_map_true)
        for row, view in _pairs(self.found, self.truth):
            x, y = self.xy(view.x, view.y)
            off = yaw_of(row[1:].reshape(4, 4)) - (view.yaw + turned)
            yield view, math.hypot(row[4] - x, row[8] - y), abs(wrap_angle(off))

    def xy(self, x: float, y: float) -> tuple[float, float]:
        """A true point in the map frame, m."""
        at = self.T_map_true @ [x, y, 0.0, 1.0]
        return float(at[0]), float(at[1])

    def box(self, thing: TrueThing) -> OrientedBox:
        """The box of a true thing in the map frame."""
        x, y = self.xy(*thing.box.center_xyz[:2])
        yaw = thing.box.yaw + yaw_of(self.T_map_true)
        return OrientedBox((x, y, thing.box.center_xyz[2]), thing.box.size_xyz, yaw)


def _pairs(found: TopologicalMap, truth: Truth) -> Iterator[tuple[Array, TrueView]]:
    at = {round(view.stamp * MS): view for view in truth.views}
    for row in found.trajectory:
        if (view := at.get(round(row[0] * MS))) is not None:
            yield row, view


def stays(truth: Truth) -> list[tuple[str, tuple[TrueView, ...]]]:
    """Rooms in the order in which the robot came to them, with its views there.

    A view in a doorway belongs to no stay and ends none.
    """
    found: list[tuple[str, list[TrueView]]] = []
    for view in truth.views:
        if view.room is None:
            continue
        if not found or found[-1][0] != view.room:
            found.append((view.room, []))
        found[-1][1].append(view)
    return [(room, tuple(views)) for room, views in found]


def return_errors(judged: Judged) -> list[float]:
    """How far off the robot was placed, m, at each view in a room that it had left before."""
    returned, known = set(), set()
    for room, views in stays(judged.truth):
        if room in known:
            returned |= {view.stamp for view in views}
        known.add(room)
    return [off for view, off, _ in judged.views() if view.stamp in returned]
