"""The map as it stood at earlier moments, built anew from what a map folder remembers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

from afkb.flow import TopologicalMap
from afkb.plugins.host import PluginHost
from afkb_mapping.memory.memory import Memory
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.memory.storing import memory_of
from afkb_mapping.rooms.opinions import with_opinions


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
        found = replace(found, trajectory=passed[passed[:, 0] <= stamp])
        return with_opinions(found, self.host.room_classifiers())

    def before(self, stamp: float) -> float:
        """Stamp of the last view before a moment, s."""
        return max((p.stamp for p in self.memory.passed if p.stamp < stamp), default=stamp)

    def view(self, start: float, end: float) -> RememberedView | None:
        """Of the views after `start` up to `end`, s, the one in which most was detected."""
        views = (v for v in self.memory.settled_views if start < v.view.stamp <= end)
        seen = [v for v in views if v.view.depth_m is not None]
        return max(seen, key=lambda v: (_detected(v), -v.view.stamp), default=None)


def _detected(seen: RememberedView) -> int:
    return sum(not d.measures.get("is_floor") for d in seen.detections)


def moments(found: TopologicalMap) -> Sequence[float]:
    """Stamps at which the paper would draw the map, s: before each new robot place, and the end."""
    begun = sorted(place.stamp for place in found.places)
    stamps = found.trajectory[:, 0]
    ends = [float(stamps[stamps < later].max()) for _, later in pairwise(begun)]
    return [*ends, float(stamps.max())]
