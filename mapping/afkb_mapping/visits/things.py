"""Things of stored maps as they are compared: where, how large, what they afford and may be."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb.store import StoredMap
from afkb.store.shapes import Json, node_json
from afkb_mapping.geometry import transform_xy, yaw_of

Array = NDArray[np.float64]

SUPPORT = "SupportAbility"
SAMPLES = 12
"""So many points along the longer side of a thing are looked at."""
SAME_HEIGHT_M = 0.05
"""Tops of one surface in two visits agree within this."""
SAME_TOP_M = 0.03
"""Tops of one thing do within this: twice what depth errs by at 2 to 3 m, in either visit."""
SAME_PLACE_M = 0.06
"""A thing whose middle is found this near is where it was: twice what the poses of two visits, and
the laying of one map over the other, are off by; besides the part of it that one visit saw less."""
SHARED_AREA = 0.5
"""Surfaces of which this part of the smaller one lies on the other are one."""
SIZE_RATIO, SIZE_SLACK_M = 1.6, 0.05
"""Two visits show so different lengths of one thing, from different sides."""
SHARED_AFFORDANCES = 0.5
SAME_BELIEF = 0.5
"""Bhattacharyya coefficient of two posteriors over categories above which they may be of one."""


@dataclass(frozen=True, slots=True, eq=False)
class ComparedThing:
    """A node that was observed, in the frame of the map that the other is compared with.

    - `polygon_xy` (N, 2) m; `height_m`: of what a look at it meets first.
    - `last_seen`: s, the clock of its map.
    """

    node: Json
    xyz: tuple[float, float, float]
    size_xyz: tuple[float, float, float]
    polygon_xy: Array
    affords: frozenset[str]
    category: Mapping[str, float]
    existence: float
    weight: float
    extent_known: bool
    last_seen: float

    @property
    def is_surface(self) -> bool:
        """Whether it is a flat top, and no body that affords support besides."""
        return SUPPORT in self.affords and self.size_xyz[2] <= SAME_HEIGHT_M

    @property
    def top_m(self) -> float:
        """Height of its upper side above the floor, m."""
        z, height = self.xyz[2], self.size_xyz[2]
        return z if SUPPORT in self.affords else z + height / 2

    @property
    def bottom_m(self) -> float:
        """Height of its foot above the floor, m."""
        return self.top_m - self.size_xyz[2]

    @property
    def yaw(self) -> float:
        """Direction of its length, rad."""
        return float(str(self.node["yaw"]))

    def points_xy(self) -> Array:
        """(N, 2) m: points all over it, seen from above."""
        low, high = self.polygon_xy.min(axis=0), self.polygon_xy.max(axis=0)
        step = max(float((high - low).max()) / SAMPLES, 1e-3)
        x, y = (np.arange(a + step / 2, b, step) for a, b in zip(low, high, strict=True))
        grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        inside = [self.covers(point) for point in grid]
        return grid[inside] if any(inside) else np.array([self.xyz[:2]])

    def covers(self, point_xy: Array) -> bool:
        """Whether a point (2,) lies within its outline."""
        outline = self.polygon_xy.astype(np.float32)
        return cv2.pointPolygonTest(outline, (float(point_xy[0]), float(point_xy[1])), False) >= 0


def things_of(stored: StoredMap, T: Array) -> Iterator[ComparedThing]:
    """All observed things of a map but the floor, moved by T (4, 4), planar."""
    for node in stored.instances("ObservedEntity"):
        told = node_json(stored, node, "ObservedEntity")
        polygon = stored.outline(node)
        if (
            polygon is None
            or len(polygon) < 3
            or "Floor" in stored.belief(node, "category", "category")
        ):
            continue
        x, y, z = (stored.number(node, f"afn:{axis}") for axis in "xyz")
        ((x, y),) = transform_xy(T, np.array([[x, y]])).tolist()
        yaw = stored.number(node, "afn:yaw") + yaw_of(T)
        told |= {"x": round(x, 3), "y": round(y, 3), "yaw": round(math.remainder(yaw, math.tau), 4)}
        length, width, height = (stored.number(node, f"afn:size{axis}") for axis in "XYZ")
        yield ComparedThing(
            node=told,
            xyz=(x, y, z),
            size_xyz=(length, width, height),
            polygon_xy=transform_xy(T, np.array(polygon)),
            affords=frozenset(stored.names(node, "afn:affords")),
            category=stored.belief(node, "category", "category"),
            existence=stored.number(node, "afn:existence", 1.0),
            weight=stored.number(node, "afn:matchingWeight", 1.0),
            extent_known=stored.name(node, "afn:extentKnown") != "false",
            last_seen=stored.number(node, "afn:lastSeen"),
        )


def is_same_place(first: ComparedThing, second: ComparedThing) -> bool:
    """Whether two things, one a visit, stand in one place as one thing would."""
    if first.is_surface != second.is_surface:
        return False
    if first.is_surface:
        level = abs(first.xyz[2] - second.xyz[2]) <= SAME_HEIGHT_M
        return level and shared_area(first, second) >= SHARED_AREA
    apart = math.dist(first.xyz[:2], second.xyz[:2])
    near = apart <= SAME_PLACE_M + _hidden_part(first, second)
    tops = abs(first.top_m - second.top_m) <= SAME_TOP_M
    # What single views say of a thing's category wavers more than where it is.
    return near and tops and _as_large(first, second) and bool(first.affords & second.affords)


def _hidden_part(first: ComparedThing, second: ComparedThing) -> float:
    """How far apart, m, the middles of one thing are, of which one visit saw less."""
    pairs = zip(first.size_xyz[:2], second.size_xyz[:2], strict=True)
    return max(abs(a - b) for a, b in pairs) / 2


def shared_area(first: ComparedThing, second: ComparedThing) -> float:
    """Part of the smaller one's outline that lies within the other's."""
    smaller, larger = sorted((first, second), key=lambda t: t.size_xyz[0] * t.size_xyz[1])
    points = smaller.points_xy()
    return sum(larger.covers(point) for point in points) / len(points)


def is_alike(first: ComparedThing, second: ComparedThing) -> bool:
    """Whether two things may be one, had it been moved: same kind, size, affordances, category."""
    return (
        first.is_surface == second.is_surface
        and (not first.is_surface or abs(first.xyz[2] - second.xyz[2]) <= SAME_HEIGHT_M)
        and _as_large(first, second)
        and _jaccard(first.affords, second.affords) >= SHARED_AFFORDANCES
        and same_belief(first, second) >= SAME_BELIEF
    )


def same_belief(first: ComparedThing, second: ComparedThing) -> float:
    """Bhattacharyya coefficient of what both may be: 1 for one posterior, 0 for none shared."""
    return sum(math.sqrt(p * second.category.get(name, 0.0)) for name, p in first.category.items())


def _as_large(first: ComparedThing, second: ComparedThing) -> bool:
    if not (first.extent_known and second.extent_known):
        return True
    return all(
        max(a, b) <= SIZE_RATIO * min(a, b) + SIZE_SLACK_M
        for a, b in zip(first.size_xyz, second.size_xyz, strict=True)
    )


def _jaccard(first: frozenset[str], second: frozenset[str]) -> float:
    return len(first & second) / max(len(first | second), 1)
