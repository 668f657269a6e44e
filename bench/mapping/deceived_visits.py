"""Each view of a later visit matched to the map of the first one: all alike, or by what moves."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OccupancyGrid, View
from afkb.inference import network_of
from afkb.plugins.host import PluginHost
from afkb.store import load
from afkb.store.vocabulary import local_name
from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.memory.storing import memory_of
from afkb_mapping.perception import Perception
from afkb_mapping.routes.route_map import RouteMap, Thing
from afkb_mapping.run_record import Stages
from afkb_simulation.truth import load_truth
from bench.mapping.deceived import beam_weights, best_pose, cell_weights, ends_of, field_of

Array = NDArray[np.float64]
Off = tuple[float, float, float]

WAYS = ("metric", "affordance", "static")
"""All cells and beams alike; each by its matching weight; what moves left out altogether (the paper
names both, §II.D.i)."""
OCCUPIED = 0.65
LEAST_BEAMS = 40
"""A view that meets less fixes no pose in any map."""
RIGHT_M, RIGHT_RAD = 0.1, math.radians(3)
"""Two steps of the search either way."""


@dataclass(frozen=True, slots=True)
class Sense:
    """A sensor as it is matched: `laser` or `depth`, of which nothing beyond `reach_m` is used."""

    name: str
    sensor: str
    reach_m: float = math.inf

    def ends(self, view: View) -> Array:
        """(N, 2) m, map frame: what a placed view meets."""
        assert view.T_map_base is not None
        ends = ends_of(view, self.sensor)
        return ends[np.hypot(*(ends - view.T_map_base[:2, 3]).T) <= self.reach_m]


LASER, DEPTH = Sense("laser", "laser"), Sense("depth", "depth")


@dataclass(frozen=True, slots=True, eq=False)
class Visits:
    """The first visit's map folder, and the later one's views at their true poses in that map."""

    folder: Path
    later: list[View]


@dataclass(frozen=True, slots=True, eq=False)
class Match:
    """What a view meets (N, 2), m, and by how much each way of matching puts it off its pose.

    `grid`, `occupied`, `moving`: the map that it was matched to, and its dynamic things.
    """

    view: View
    ends_xy: Array
    off: Mapping[str, Off]
    grid: OccupancyGrid
    occupied: NDArray[np.bool_]
    moving: Sequence[Thing]

    def is_right(self, way: str) -> bool:
        """Whether it was put where it was taken."""
        return bool(self.off_m(way) <= RIGHT_M + 1e-9 and self.off_rad(way) <= RIGHT_RAD + 1e-9)

    def off_m(self, way: str) -> float:
        """Distance from the true place, m."""
        return math.hypot(*self.off[way][:2])

    def off_rad(self, way: str) -> float:
        """Angle to the true heading."""
        return abs(self.off[way][2])


def simulated(
    host: PluginHost, folder: Path, first: str | Path, later: Path, stride: int
) -> Visits:
    """Visits of two simulated worlds, of the first of which `folder` is the map."""
    T_map_world = np.linalg.inv(load_truth(str(first)).T_world_base[0])
    T_map_world[2, 3] = 0.0
    true = load_truth(str(later)).T_world_base
    views = host.open_source(str(later), {}).views(stride=stride)
    placed = [
        replace(v, T_map_base=T_map_world @ true[v.index])
        for v in views
        if isinstance(v, View) and v.scan is not None
    ]
    return Visits(folder, placed)


def matches(host: PluginHost, visits: Visits, senses: Sequence[Sense]) -> dict[str, list[Match]]:
    """By sense: the later visit's views that meet enough, as each way of matching places them."""
    network, known = network_of(host.knowledge_base), RouteMap.read(visits.folder)
    stored = load(visits.folder)
    nodes = stored.instances("ObservedEntity")
    dynamic = {local_name(n.value) for n in nodes if stored.name(n, "afn:movability") == "Dynamic"}
    things = list(known.things.values())
    perception = Perception(host.detectors(()), Stages())
    detections = [perception.detections(view) for view in visits.later]
    found: dict[str, list[Match]] = {}
    for sense in senses:
        grid = _met(visits.folder, sense)
        occupied = np.nan_to_num(grid.probability, nan=0.0) > OCCUPIED
        weights = cell_weights(grid, things, dynamic)
        plain = field_of(grid, occupied, np.ones_like(weights))
        weighed = field_of(grid, occupied, weights)
        static = field_of(grid, occupied, np.floor(weights))
        moving = [t for t in things if t.id in dynamic]
        found[sense.name] = []
        for view, seen in zip(visits.later, detections, strict=True):
            ends = sense.ends(view)
            if len(ends) < LEAST_BEAMS:
                continue
            beams = beam_weights(ends, seen, network)
            off = {
                "metric": best_pose(view, ends, plain, np.ones(len(ends))),
                "affordance": best_pose(view, ends, weighed, beams),
                "static": best_pose(view, ends, static, np.floor(beams)),
            }
            found[sense.name].append(Match(view, ends, off, grid, occupied, moving))
    return found


def _met(folder: Path, sense: Sense) -> OccupancyGrid:
    """What the views of a visit have met: a plain metric map."""
    builder = GridBuilder()
    for remembered in memory_of(folder).settled_views:
        view = remembered.view
        ends = sense.ends(view)
        builder.insert_beams(view.T_map_base[:2, 3], ends, np.ones(len(ends), dtype=np.bool_))
    return builder.grid()


def summary(found: Sequence[Match], way: str) -> dict[str, float]:
    """How often a way of matching is right, and by how much it is off."""
    off = np.array([m.off_m(way) for m in found])
    turned = np.array([m.off_rad(way) for m in found])
    return {
        "right": round(float(np.mean([m.is_right(way) for m in found])), 4),
        "mean_m": round(float(off.mean()), 4),
        "greatest_m": round(float(off.max()), 4),
        "greatest_deg": round(math.degrees(float(turned.max())), 2),
    }
