"""Whether moved chairs deceive a metric map: a robot in a hall of chairs, walls far off.

    python -m bench.mapping deceived_hall [--halls 6] [--seed 1] [--picture FILE.svg]

Halls of chairs and a few tables are drawn (`hall.py`), each mapped and visited later, after all its
chairs were shoved aside, by one vector or each by its own. Every view of the later visit is matched
from near its true pose to the first visit's occupancy grid: with all cells and beams alike, by
movability, and with what moves left out. Nothing is picked: all views of all halls that meet enough
are counted. The picture is of the view at the median error among those that the metric map gets
wrong, by the shorter-sighted laser after all chairs went one way.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from afkb.plugins.host import PluginHost
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from bench.mapping.deceived_picture import picture
from bench.mapping.deceived_visits import DEPTH, LASER, WAYS, Match, Sense, matches, simulated
from bench.mapping.hall import hall, shoved, written

NEAR = Sense("laser within 3.5 m", "laser", 3.5)
"""What a laser of small robots sees, or any amid people."""
SENSES = (LASER, NEAR, DEPTH)
SHOVED = {"all by one vector": True, "each by its own": False}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """How many halls are drawn."""
    parser.add_argument("--halls", type=int, default=6, help="so many halls are drawn")
    parser.add_argument("--seed", type=int, default=1, help="of the drawing")
    parser.add_argument("--stride", type=int, default=2, help="every N-th view of a later visit")
    parser.add_argument("--picture", type=Path, help="SVG of the median view of those put wrong")


def run(args: argparse.Namespace) -> dict[str, Any]:
    """By how chairs were shoved and by sense: how many views each way of matching gets right."""
    host, rng = PluginHost(), np.random.default_rng(args.seed)
    found: dict[str, dict[str, list[Match]]] = {how: {s.name: [] for s in SENSES} for how in SHOVED}
    for _ in range(args.halls):
        with tempfile.TemporaryDirectory() as scratch:
            folder, world = Path(scratch) / "map", hall(rng)
            first = written(world, Path(scratch) / "first.world.yaml")
            make_map(host, Settings(uri=str(first), out=folder))
            for how, together in SHOVED.items():
                later = shoved(world, rng, together)
                path = written(later, Path(scratch) / "later.world.yaml")
                visits = simulated(host, folder, first, path, args.stride)
                for sense, views in matches(host, visits, SENSES).items():
                    found[how][sense] += views
    if args.picture is not None:
        chosen = _median_wrong(found["all by one vector"][NEAR.name])
        args.picture.write_text(picture(chosen), encoding="utf-8")
    return {
        "halls": args.halls,
        "matched": {
            how: {sense: _told(views) for sense, views in by_sense.items()}
            for how, by_sense in found.items()
        },
    }


def _told(views: Sequence[Match]) -> dict[str, Any]:
    return {
        "views": len(views),
        **{way: sum(m.is_right(way) for m in views) for way in WAYS},
        "mean_m": {w: round(float(np.mean([m.off_m(w) for m in views])), 3) for w in WAYS},
    }


def _median_wrong(views: Sequence[Match]) -> Match:
    wrong = sorted((m for m in views if not m.is_right("metric")), key=lambda m: m.off_m("metric"))
    return (wrong or list(views))[len(wrong) // 2]


def table(result: dict[str, Any]) -> Iterator[str]:
    """Of how many views each way is right, by how chairs were shoved and by sense."""
    yield f"{result['halls']} halls: share of views right within 0.1 m and 3°; mean error, m"
    yield f"{'':40} views  {'all alike':>14}  {'by movability':>14}  {'without dynamic':>15}"
    for how, by_sense in result["matched"].items():
        for sense, r in by_sense.items():
            told = [f"{r[way] / r['views']:.2f}; {r['mean_m'][way]:.3f}" for way in WAYS]
            yield f"{f'{how}, {sense}':40} {r['views']:5d}  " + "  ".join(f"{t:>14}" for t in told)
