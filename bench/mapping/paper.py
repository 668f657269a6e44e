"""The paper's figures, and what its claim comes to that moved things deceive a metric map.

    python -m bench.mapping paper [--first HOME --later HOME] [--pictures FOLDER]

Figures of the simulated home of Fig. 2: place nodes, transient nodes per waypoint, loop error. Then
a later visit, after what moves was moved or has gone: each of its views is matched, from near its
true pose, to the map of the first visit, once with all cells and beams alike and once weighted by
movability. Without `--first` and `--later` (homes with `bag/` and `truth.json`) both visits are of
the simulated home, the later one rearranged.
"""

from __future__ import annotations

import argparse
import json
import math
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OccupancyGrid, View
from afkb.inference import network_of
from afkb.plugins.host import PluginHost
from afkb.store import load
from afkb.store.vocabulary import local_name
from afkb_mapping.demo_table import transient_per_place
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.memory.storing import memory_of
from afkb_mapping.occupancy import GridBuilder
from afkb_mapping.perception import Perception
from afkb_mapping.routes.route_map import RouteMap, Thing
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings, Stages
from afkb_simulation.reading import world_path
from afkb_simulation.truth import load_truth
from bench.detectors.seen import placed_views
from bench.mapping.deceived import beam_weights, best_pose, cell_weights, ends_of, field_of
from bench.mapping.deceived_picture import picture
from bench.mapping.rearranged import rearranged
from bench.paper_home import compare

Array = NDArray[np.float64]
Off = tuple[float, float, float]

WORLD = "world:paper_home"
SENSES = ("laser", "depth")
OCCUPIED = 0.65
LEAST_BEAMS = 40
"""A view that meets less fixes no pose in any map."""
RIGHT_M, RIGHT_RAD = 0.1, math.radians(3)
"""Two steps of the search either way."""
SEED = 5


@dataclass(frozen=True, slots=True, eq=False)
class Visits:
    """The first visit's map folder, and the later one's views at their true poses in that map."""

    folder: Path
    later: list[View]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Two visits of one home, and where the picture goes."""
    parser.add_argument("--first", type=Path, help="home with bag/ and truth.json")
    parser.add_argument("--later", type=Path, help="the same home at a later visit")
    parser.add_argument("--stride", type=int, default=2, help="every N-th view of the later visit")
    parser.add_argument("--pictures", type=Path, help="folder for the picture of the claim")


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Figures of the simulated home, and how often each way of matching is deceived."""
    host = PluginHost()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "map"
        found = make_map(host, Settings(uri=WORLD, out=folder)).topological_map
        figures = compare(found, load_truth(WORLD))
        figures["transient nodes per place (paper: ~3)"] = round(transient_per_place(found), 1)
        if args.first and args.later:
            visits = _homes(host, args, Path(scratch))
        else:
            visits = _worlds(host, folder, args.stride, Path(scratch))
        matched = _matched(host, visits, args.pictures)
    return {"figures": figures, "later visit": str(args.later or "simulated"), "matched": matched}


def _homes(host: PluginHost, args: argparse.Namespace, scratch: Path) -> Visits:
    folder = scratch / "first"
    make_map(host, Settings(uri=str(args.first / "bag"), out=folder))
    first = json.loads((args.first / "truth.json").read_text())["views"][0]
    T_map_world = np.linalg.inv(T_from_xy_yaw(first["x"], first["y"], first["yaw"]))
    truth = json.loads((args.later / "truth.json").read_text())
    views = host.open_source(str(args.later / "bag")).views(stride=args.stride)
    return Visits(
        folder,
        [
            replace(v, T_map_base=T_map_world @ v.T_map_base)
            for v in placed_views(views, truth)
            if v.T_map_base is not None
        ],
    )


def _worlds(host: PluginHost, folder: Path, stride: int, scratch: Path) -> Visits:
    world = rearranged(world_path(WORLD), scratch / "later.world.yaml", host.knowledge_base, SEED)
    T_map_world = np.linalg.inv(load_truth(WORLD).T_world_base[0])
    T_map_world[2, 3] = 0.0
    true = load_truth(str(world)).T_world_base
    views = host.open_source(str(world), {}).views(stride=stride)
    placed = [replace(v, T_map_base=T_map_world @ true[v.index]) for v in views if _has_scan(v)]
    return Visits(folder, placed)


def _has_scan(view: object) -> bool:
    return isinstance(view, View) and view.scan is not None


def _matched(host: PluginHost, visits: Visits, pictures: Path | None) -> dict[str, Any]:
    network, known = network_of(host.knowledge_base), RouteMap.read(visits.folder)
    stored = load(visits.folder)
    nodes = stored.instances("ObservedEntity")
    dynamic = {local_name(n.value) for n in nodes if stored.name(n, "afn:movability") == "Dynamic"}
    things = list(known.things.values())
    perception = Perception(host.detectors(()), Stages())
    detections = [perception.detections(view) for view in visits.later]
    told: dict[str, Any] = {}
    for sense in SENSES:
        grid = _met(visits.folder, sense)
        occupied = np.nan_to_num(grid.probability, nan=0.0) > OCCUPIED
        weights = cell_weights(grid, things, dynamic)
        plain = field_of(grid, occupied, np.ones_like(weights))
        weighed = field_of(grid, occupied, weights)
        errors: dict[str, list[Off]] = {"metric": [], "affordance": []}
        seen = []
        for view, found in zip(visits.later, detections, strict=True):
            ends = ends_of(view, sense)
            if len(ends) < LEAST_BEAMS:
                continue
            beams = beam_weights(ends, found, network)
            errors["metric"].append(best_pose(view, ends, plain, np.ones(len(ends))))
            errors["affordance"].append(best_pose(view, ends, weighed, beams))
            seen.append((view, ends))
        told[sense] = {"views": len(seen), **{n: _summary(e) for n, e in errors.items()}}
        if pictures is not None:
            moving = [t for t in things if t.id in dynamic]
            _draw(pictures / f"deceived-{sense}.svg", grid, occupied, moving, seen, errors)
    return told


def _met(folder: Path, sense: str) -> OccupancyGrid:
    """What the views of a visit have met: a plain metric map."""
    builder = GridBuilder()
    for remembered in memory_of(folder).settled_views:
        view = remembered.view
        ends = ends_of(view, sense)
        builder.insert_beams(view.T_map_base[:2, 3], ends, np.ones(len(ends), dtype=np.bool_))
    return builder.grid()


def _summary(errors: list[Off]) -> dict[str, float]:
    off = np.array([math.hypot(x, y) for x, y, _ in errors])
    turned = np.array([abs(yaw) for _, _, yaw in errors])
    right = (off <= RIGHT_M + 1e-9) & (turned <= RIGHT_RAD + 1e-9)
    return {
        "right": round(float(right.mean()), 4),
        "mean_m": round(float(off.mean()), 4),
        "greatest_m": round(float(off.max()), 4),
        "greatest_deg": round(math.degrees(float(turned.max())), 2),
    }


def _draw(
    file: Path,
    grid: OccupancyGrid,
    occupied: NDArray[np.bool_],
    things: list[Thing],
    seen: list[tuple[View, Array]],
    errors: dict[str, list[Off]],
) -> None:
    """The view in which the two ways of matching differ most."""
    off = {n: [math.hypot(x, y) + abs(t) for x, y, t in e] for n, e in errors.items()}
    worst = int(np.argmax(np.subtract(off["metric"], off["affordance"])))
    poses = {name: errors[name][worst] for name in errors}
    file.parent.mkdir(parents=True, exist_ok=True)
    view, ends = seen[worst]
    file.write_text(picture(grid, occupied, things, view, ends, poses), encoding="utf-8")


def table(result: dict[str, Any]) -> Iterator[str]:
    """The figures, then both ways of matching."""
    for what, value in result["figures"].items():
        yield f"{what}: {value}"
    for sense, matched in result["matched"].items():
        yield f"{matched['views']} views of a later visit ({result['later visit']}), by {sense}"
        yield f"  {'':12} right (0.1 m, 3°)  mean m  greatest m  greatest °"
        for name in ("metric", "affordance"):
            r = matched[name]
            yield (
                f"  {name:12} {r['right']:17.3f} {r['mean_m']:7.3f} {r['greatest_m']:11.3f}"
                f" {r['greatest_deg']:11.1f}"
            )
