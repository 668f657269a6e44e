"""Robot places, V_r: a new one where the affordances in view change (paper §II.E)."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.box_index import BoxIndex
from afkb_mapping.geometry import yaw_of

PLACE_SPACING_M = 2.0
"""A robot that turns on the spot, or moves less than this, stays at its place."""
FAMILIAR_SHARE = 0.5
"""A view belongs to a place from which at least this share of its entities was already seen."""
FAR_PLACE_M = 5.0
"""Where nothing affords anything, in a corridor or with a laser alone, a new place begins here."""
SAME_PLACE_M = 2.5
"""Beyond this distance a view belongs to no earlier place, however much of it is familiar."""


class Surroundings(Protocol):
    """What the grid so far tells of the straight line between two points, m."""

    def in_sight(self, start_xy: tuple[float, float], end_xy: NDArray[np.float64]) -> bool:
        """Whether nothing stands on it."""
        ...

    def doorway_between(self, start_xy: tuple[float, float], end_xy: NDArray[np.float64]) -> bool:
        """Whether it squeezes through a passage."""
        ...


@dataclass(slots=True, eq=False)
class Place:
    """A node of V_r with what was seen from it (ids of entities)."""

    id: str
    x: float
    y: float
    yaw: float
    stamp: float
    view_index: int
    seen: dict[str, None] = field(default_factory=dict)


class Places:
    """The places in order of discovery, the current one, and the ways taken between them.

    `ways`: from id to id, with how far the robot went at least, m, the one time it went least far.
    """

    def __init__(self, new_id: Callable[[str], str]) -> None:
        self.places: list[Place] = []
        self.ways: dict[tuple[str, str], float] = {}
        self.current: Place | None = None
        self._last_xy = np.zeros(2)
        self._by_place: BoxIndex[Place] = BoxIndex()
        self._new_id = new_id

    def visit(self, view: View, entities: Collection[str], grid: Surroundings) -> Place:
        """The place of a view in which these entities are: an earlier one, or a new one.

        A place holds only what can be reached from it straight on, and through no doorway.
        """
        assert view.T_map_base is not None
        xy = view.T_map_base[:2, 3]
        place = self._belongs_to(xy, set(entities), grid) or self._new_place(view)
        if self.current is not None and self.current is not place:
            self._go(self.current, place, xy)
        self.current, self._last_xy = place, xy
        place.seen.update(dict.fromkeys(entities))
        return place

    def _go(self, start: Place, end: Place, xy: NDArray[np.float64]) -> None:
        """Note a way: from the one place to where the robot was seen last there, and on here."""
        along = np.array([(start.x, start.y), self._last_xy, xy, (end.x, end.y)])
        went = float(np.linalg.norm(np.diff(along, axis=0), axis=1).sum())
        way = start.id, end.id
        self.ways[way] = min(went, self.ways.get(way, went))

    def _belongs_to(
        self, xy: NDArray[np.float64], entities: set[str], grid: Surroundings
    ) -> Place | None:
        around = self._by_place.near(xy - FAR_PLACE_M, xy + FAR_PLACE_M)
        near = sorted((float(np.hypot(p.x - xy[0], p.y - xy[1])), p.id, p) for p in around)
        for distance, _, place in near:
            at = (place.x, place.y)
            if distance > FAR_PLACE_M or grid.doorway_between(at, xy):
                continue
            if distance < PLACE_SPACING_M:
                return place
            if not grid.in_sight(at, xy):
                continue
            if not entities and place is self.current:
                return place
            familiar = len(entities & place.seen.keys()) >= FAMILIAR_SHARE * len(entities)
            if entities and familiar and distance < SAME_PLACE_M:
                return place
        return None

    def _new_place(self, view: View) -> Place:
        assert view.T_map_base is not None
        T = view.T_map_base
        place = Place(
            self._new_id("place"), float(T[0, 3]), float(T[1, 3]), yaw_of(T), view.stamp, view.index
        )
        self.places.append(place)
        self._by_place.put(place, T[:2, 3], T[:2, 3])
        return place
