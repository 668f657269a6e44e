"""What a view costs as the map grows: a tour made again and again, and a home of many flats.

    python -m bench.mapping growth [--map MAP] [--views 10000] [--flats 25]

The views are those that a map remembers. *Again*: the same tour round and round, every view
mapped. *Flats*: the same home side by side, so that 25 flats of four rooms are 100 rooms; each is
toured once, and the map finished and written.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.inference import network_of
from afkb.plugins.host import PluginHost
from afkb.store import load, write_map
from afkb_mapping.localisation.bands import BandBuilder
from afkb_mapping.mapper import AffordanceMapper
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.memory.storing import memory_of
from afkb_mapping.placing.registration import ScanRegistration
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from bench.detectors.data import NoData

Array = NDArray[np.float64]

WORLD = "world:paper_home"
BETWEEN_M = 3.0
"""Between flats: more than their outer walls and what is seen through windows."""
SPANS = ((100, 200), (1_000, 1_100), (3_000, 3_100), (9_900, 10_000))
"""Views whose cost is told apart, as many as there are."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which tour, and how long and how far it is made."""
    parser.add_argument("--map", type=Path, help="a map whose views are taken; else one is made")
    parser.add_argument("--source", default=WORLD, help="recording to map where none is given")
    parser.add_argument("--views", type=int, default=10_000, help="length of the long tour")
    parser.add_argument("--flats", type=int, default=25, help="copies of the home side by side")


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Seconds and bytes of both tours."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = args.map or Path(scratch) / "map"
        if args.map is None:
            make_map(PluginHost(), Settings(uri=args.source, out=folder))
        views = list(memory_of(folder).settled_views)
        if not views:
            raise NoData(f"{folder}: remembers no views; map it again")
        rooms = len(load(folder).instances("Room"))
        # The long tour first: memory is told at most so far.
        again = _again(views, args.views)
        flats = _flats(views, args.flats, Path(scratch) / "flats") | {"rooms_each": rooms}
        return {"flats": flats, "again": again}


def _flats(views: list[RememberedView], copies: int, out: Path) -> dict[str, Any]:
    """Each copy toured once; medians of what a view of the copy costs."""
    host, tour = PluginHost(), _Tour()
    places = np.array([v.T_map_base[:2, 3] for v in views])
    extent = places.max(axis=0) - places.min(axis=0) + 2 * BETWEEN_M + 8.0
    side = int(np.ceil(np.sqrt(copies)))
    costs = []
    for copy in range(copies):
        offset = extent * [copy % side, copy // side]
        taken = tour.take(_moved(v, offset, copy * len(views) + i) for i, v in enumerate(views))
        costs.append(_medians(list(taken)))
    start = time.thread_time()
    found = tour.mapper.finish(np.eye(4))
    finished = time.thread_time() - start
    exporters = [e for e in host.exporters() if e.in_map_folder]
    write_map(out, found, {}, exporters, host.knowledge_base)
    nodes = len(found.places) + len(found.entities)
    return {
        "flats": copies,
        "rooms": len(found.rooms),
        "nodes": nodes,
        "ms_first": costs[0],
        "ms_middle": costs[len(costs) // 2],
        "ms_last": costs[-1],
        "finish_s": round(finished, 2),
        "map_json_bytes_per_node": round((out / "map.json").stat().st_size / nodes),
        "scene_bytes_per_node": round((out / "scene.ttl").stat().st_size / nodes),
        "memory_mb": _memory_mb(),
    }


def _again(views: list[RememberedView], count: int) -> dict[str, Any]:
    """The tour over and over; medians of what a view costs, early and late."""
    tour, costs, memory = _Tour(), [], {}
    for n, cost in enumerate(
        tour.take(_moved(views[i % len(views)], np.zeros(2), i) for i in range(count)), start=1
    ):
        costs.append(cost)
        if n in (count // 10, count):
            memory[str(n)] = _memory_mb()
    spans = [(a, b) for a, b in SPANS if b <= count] or [(0, count)]
    return {
        "ms": {f"{a}-{b}": _medians(costs[a:b]) for a, b in spans},
        "memory_mb": memory,
    }


class _Tour:
    """A mapper with its height bands and registration, timed view by view."""

    def __init__(self) -> None:
        self.mapper = AffordanceMapper(network_of(PluginHost().knowledge_base), "log-odds")
        self._bands = BandBuilder()
        self._registration = ScanRegistration(np.eye(4))

    def take(self, views: Iterable[RememberedView]) -> Iterator[dict[str, float]]:
        """Milliseconds of each stage, view by view."""
        for seen in views:
            stamps = [time.thread_time()]
            self._registration.place(replace(seen.view, T_odom_base=seen.T_map_base))
            stamps.append(time.thread_time())
            self.mapper.add(seen.view, seen.detections, seen.hypotheses)
            stamps.append(time.thread_time())
            self._bands.add(seen.view)
            stamps.append(time.thread_time())
            yield dict(zip(("register", "map", "bands"), 1e3 * np.diff(stamps), strict=True))


def _moved(seen: RememberedView, offset_xy: Array, index: int) -> RememberedView:
    T = seen.T_map_base.copy()
    T[:2, 3] += offset_xy
    moved = seen.moved_to(T)
    return replace(moved, view=replace(moved.view, index=index, stamp=index / 2))


def _medians(costs: list[dict[str, float]]) -> dict[str, float]:
    return {k: round(float(np.median([c[k] for c in costs])), 2) for k in costs[0]}


def _memory_mb() -> float:
    return round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, 1)


def table(result: dict[str, Any]) -> Iterator[str]:
    """Both tours, line by line."""
    flats = result["flats"]
    yield f"{flats['flats']} flats of {flats['rooms_each']} rooms: CPU ms a view (median)"
    for name in ("first", "middle", "last"):
        yield f"  {name + ' flat':14} {_costs(flats['ms_' + name])}"
    yield (
        f"  finished in {flats['finish_s']} s: {flats['rooms']} rooms, {flats['nodes']} nodes of "
        f"{flats['map_json_bytes_per_node']} bytes in map.json, "
        f"{flats['scene_bytes_per_node']} in scene.ttl; {flats['memory_mb']} MB at most"
    )
    yield "the tour again and again: CPU ms a view (median)"
    for span, costs in result["again"]["ms"].items():
        yield f"  views {span:12} {_costs(costs)}"
    yield "  memory at most: " + ", ".join(
        f"{mb} MB after {n} views" for n, mb in result["again"]["memory_mb"].items()
    )


def _costs(costs: dict[str, float]) -> str:
    return ", ".join(f"{name} {ms:.1f}" for name, ms in costs.items())
