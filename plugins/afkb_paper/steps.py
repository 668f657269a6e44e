"""The map as it stood at earlier moments, built anew from what a map folder remembers."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from pathlib import Path

from afkb.flow import RobotPlace, TopologicalMap
from afkb.plugins.host import PluginHost
from afkb_mapping.memory.memory import Memory
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.memory.storing import memory_of
from afkb_mapping.structure import is_structure

AT_PLACE_M = 1.0
"""Half of the least distance between two places of a map: nearer, a view shows what is there."""


@dataclass(frozen=True, slots=True, eq=False)
class Steps:
    """Maps of the first views of a recording, each where it turned out to have been taken."""

    host: PluginHost
    memory: Memory
    _made: dict[tuple[float, bool], TopologicalMap] = field(default_factory=dict)

    @classmethod
    def of(cls, folder: Path, host: PluginHost) -> Steps:
        """Of a map folder; raises `MapError` where it remembers no views."""
        return cls(host, memory_of(folder))

    def until(self, stamp: float, predicting: bool = True) -> TopologicalMap:
        """The map of all views up to a moment, s; without `predicting`, of what was seen alone.

        The latter is what a topological map would be that knows of no affordances (paper §III).
        """
        if (stamp, predicting) not in self._made:
            self._made[stamp, predicting] = self._map(stamp, predicting)
        return self._made[stamp, predicting]

    def _map(self, stamp: float, predicting: bool) -> TopologicalMap:
        visit = self.memory.visits[-1]
        factory = self.host.mapper_factory(str(visit.parameters["mapper"]))
        mapper = factory(str(visit.parameters["rule"]))
        for seen in self.memory.settled_views:
            if seen.view.stamp <= stamp:
                mapper.add(seen.view, seen.detections, seen.hypotheses if predicting else ())
        found = mapper.finish(visit.T_map_source)
        passed = self.memory.trajectory
        return replace(found, trajectory=passed[passed[:, 0] <= stamp])

    def before(self, stamp: float) -> float:
        """Stamp of the last view before a moment, s."""
        return max((p.stamp for p in self.memory.passed if p.stamp < stamp), default=stamp)

    def view_at(self, place: RobotPlace, start: float, end: float) -> RememberedView | None:
        """Of the views at a place from one moment to another, s, the one that shows most things."""
        seen = [
            v
            for v in self.memory.settled_views
            if start <= v.view.stamp <= end
            and v.view.depth_m is not None
            and math.dist(v.T_map_base[:2, 3], (place.x, place.y)) <= AT_PLACE_M
        ]
        return max(seen, key=lambda v: (_things(v), -v.view.stamp), default=None)


def _things(seen: RememberedView) -> int:
    return sum(not is_structure(d) for d in seen.detections)


def moments(found: TopologicalMap) -> list[tuple[RobotPlace, float]]:
    """Each place of the robot, in their order, with when the paper would draw the map, s.

    That is before the robot comes to the next new place, and at the end.
    """
    places = sorted(found.places, key=lambda place: place.stamp)
    stamps = found.trajectory[:, 0]
    ends = [float(stamps[stamps < later.stamp].max()) for later in places[1:]]
    return list(zip(places, [*ends, float(stamps.max())], strict=True))
