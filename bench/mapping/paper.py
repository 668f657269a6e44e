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
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from afkb.plugins.host import PluginHost
from afkb_mapping.demo_table import transient_per_place
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from afkb_simulation.reading import world_path
from bench.mapping.deceived_picture import picture
from bench.mapping.deceived_visits import (
    DEPTH,
    LASER,
    WAYS,
    Match,
    Visits,
    matches,
    simulated,
    summary,
)
from bench.mapping.rearranged import rearranged
from bench.mapping.true_views import true_views, truth_of
from bench.paper_home import compare

WORLD = "world:paper_home"
SEED = 5


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
        truth = host.truth(WORLD)
        assert truth is not None
        figures = compare(found, truth)
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
    return Visits(folder, true_views(host, args.later, truth_of(args.first), args.stride))


def _worlds(host: PluginHost, folder: Path, stride: int, scratch: Path) -> Visits:
    world = rearranged(world_path(WORLD), scratch / "later.world.yaml", host.knowledge_base, SEED)
    return simulated(host, folder, WORLD, world, stride)


def _matched(host: PluginHost, visits: Visits, pictures: Path | None) -> dict[str, Any]:
    told: dict[str, Any] = {}
    for sense, found in matches(host, visits, (LASER, DEPTH)).items():
        told[sense] = {"views": len(found), **{way: summary(found, way) for way in WAYS}}
        if pictures is not None:
            pictures.mkdir(parents=True, exist_ok=True)
            drawn = picture(max(found, key=_differs))
            (pictures / f"deceived-{sense}.svg").write_text(drawn, encoding="utf-8")
    return told


def _differs(match: Match) -> float:
    """By how much farther off (m and rad) a view is with all alike."""
    metric, affordance = (match.off_m(way) + match.off_rad(way) for way in WAYS[:2])
    return metric - affordance


def table(result: dict[str, Any]) -> Iterator[str]:
    """The figures, then both ways of matching."""
    for what, value in result["figures"].items():
        yield f"{what}: {value}"
    for sense, matched in result["matched"].items():
        yield f"{matched['views']} views of a later visit ({result['later visit']}), by {sense}"
        yield f"  {'':12} right (0.1 m, 3°)  mean m  greatest m  greatest °"
        for name in WAYS:
            r = matched[name]
            yield (
                f"  {name:12} {r['right']:17.3f} {r['mean_m']:7.3f} {r['greatest_m']:11.3f}"
                f" {r['greatest_deg']:11.1f}"
            )
