"""A mapper in a page: where the robot stood, what supports, what rolls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.flow import (
    Detection,
    Edge,
    EdgeKind,
    Entity,
    Hypothesis,
    NodeKind,
    OccupancyGrid,
    RobotPlace,
    TopologicalMap,
    View,
)
from afkb.inference import Network

KEPT = ("SupportAbility", "RollAbility3D")
SAME_THING_M, SAME_PLACE_M, CELL_M = 0.35, 1.0, 0.05
FLOOR_M = 0.1


@dataclass(slots=True)
class _Thing:
    """A thing with every detection of it."""

    seen: list[Detection]
    views: dict[int, float] = field(default_factory=dict)
    places: dict[str, None] = field(default_factory=dict)

    def matches(self, detection: Detection) -> bool:
        """Whether the detection affords the same, about where this thing is."""
        last = self.seen[-1]
        near = np.linalg.norm(last.position_xyz - detection.position_xyz) < SAME_THING_M
        return bool(near) and set(last.affordances) == set(detection.affordances)


class SkeletonMapper:
    """Keeps places a metre apart and one node for each support or rolling thing."""

    def __init__(self, network: Network) -> None:
        self._network = network
        self._places: list[RobotPlace] = []
        self._things: list[_Thing] = []
        self._trajectory: list[list[float]] = []

    def add(
        self, view: View, detections: Sequence[Detection], hypotheses: Sequence[Hypothesis]
    ) -> None:
        """Take in a view; hypotheses are left aside."""
        assert view.T_map_base is not None
        self._trajectory.append([view.stamp, *view.T_map_base.ravel().tolist()])
        place = self._place(view, view.T_map_base)
        for detection in detections:
            if any(map(detection.affords, KEPT)) and detection.position_xyz[2] > FLOOR_M:
                thing = next((t for t in self._things if t.matches(detection)), None)
                if thing is None:
                    thing = _Thing([])
                    self._things.append(thing)
                thing.seen.append(detection)
                thing.views[view.index] = view.stamp
                thing.places[place.id] = None

    def _place(self, view: View, T_map_base: NDArray[np.float64]) -> RobotPlace:
        x, y = (float(v) for v in T_map_base[:2, 3])
        for place in self._places:
            if np.hypot(place.x - x, place.y - y) < SAME_PLACE_M:
                return place
        yaw = float(np.arctan2(T_map_base[1, 0], T_map_base[0, 0]))
        place = RobotPlace(f"place-{len(self._places) + 1}", x, y, yaw, view.stamp, view.index)
        self._places.append(place)
        return place

    def finish(self, T_map_source: NDArray[np.float64]) -> TopologicalMap:
        """The map of what was added so far."""
        entities = tuple(self._entity(i, t) for i, t in enumerate(self._things, start=1))
        return TopologicalMap(
            places=tuple(self._places),
            entities=entities,
            bounds=(),
            doorways=(),
            rooms=(),
            edges=tuple(self._edges(entities)),
            grid=self._grid(),
            T_map_source=T_map_source,
            trajectory=np.array(self._trajectory, dtype=np.float64).reshape(-1, 17),
        )

    def _entity(self, number: int, thing: _Thing) -> Entity:
        best = max(thing.seen, key=lambda d: d.n_pixels)
        size, top = best.box.size_xyz, best.box.top
        belief = self._network.category_posterior(best.affordances, size, top)
        movability, weight = self._network.movability(belief)
        x, y, z = (float(v) for v in np.mean([d.position_xyz for d in thing.seen], axis=0))
        stamps = list(thing.views.values())
        return Entity(
            id=f"thing-{number}",
            kind=NodeKind.OBSERVED,
            position_xyz=(x, y, z),
            size_xyz=size,
            yaw=best.box.yaw,
            affordances=best.affordances,
            existence=1.0 - 0.5 ** len(thing.views),
            category_belief=belief,
            movability=movability,
            matching_weight=weight,
            observations=len(thing.views),
            first_seen=min(stamps),
            last_seen=max(stamps),
            seen_from=tuple(thing.places),
            generated_by=(best.detector,),
        )

    def _edges(self, entities: Sequence[Entity]) -> list[Edge]:
        places = {p.id: p for p in self._places}
        edges = []
        for entity in entities:
            for place in (places[i] for i in entity.seen_from):
                dx, dy = entity.position_xyz[0] - place.x, entity.position_xyz[1] - place.y
                edges.append(
                    Edge(
                        id=f"edge-{len(edges) + 1}",
                        kind=EdgeKind.OBSTACLE,
                        source=place.id,
                        target=entity.id,
                        distance=float(np.hypot(dx, dy)),
                        bearing=float(np.arctan2(dy, dx)),
                    )
                )
        return edges

    def _grid(self) -> OccupancyGrid:
        """What the things stand on is occupied, where the robot drove is free."""
        drove = np.array([[row[4], row[8]] for row in self._trajectory]).reshape(-1, 2)
        stood = [d.footprint_xy for t in self._things for d in t.seen]
        everything = np.concatenate([drove, *stood])
        origin = np.floor((everything.min(axis=0) - 0.5) / CELL_M) * CELL_M
        columns, rows = (np.ceil((everything.max(axis=0) + 0.5 - origin) / CELL_M)).astype(int)
        cells = np.full((rows, columns), np.nan, dtype=np.float32)
        for points, probability in ((drove, 0.05), *((s, 0.9) for s in stood)):
            x, y = ((points - origin) / CELL_M).astype(int).T
            cells[y, x] = probability
        return OccupancyGrid(cells, CELL_M, (float(origin[0]), float(origin[1])))
