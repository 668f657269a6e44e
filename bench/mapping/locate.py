"""Self-localisation of views in the map of another visit, with no idea of where they were taken."""

from __future__ import annotations

import argparse
import math
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb.plugins.host import PluginHost
from afkb_mapping.geometry import transform_xy
from afkb_mapping.localisation.bands import STATE_FILE, HeightBands
from afkb_mapping.localisation.localiser import Localiser
from afkb_mapping.localisation.questions import asked
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from bench.detectors.data import NoData, data_folder
from bench.mapping.locate_answers import (
    HEADER,
    SEED,
    SENSES,
    Ask,
    Told,
    answers,
    by_distance,
    depth,
    lines,
    shares,
)
from bench.mapping.locate_changes import without
from bench.mapping.locate_peers import Peer, peers_in
from bench.mapping.true_views import T_map_world, Truth, true_views, truth_of

GONE = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Shares of the low things that are taken out of the map."""

Array = NDArray[np.float64]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What is asked where: homes are folders with `bag/` and `truth.json`."""
    homes = data_folder() / "homes"
    parser.add_argument("--map", type=Path, help="map of --mapped that stands already")
    parser.add_argument("--mapped", type=Path, default=homes / "merom")
    parser.add_argument("--asked", type=Path, default=homes / "merom-later")
    parser.add_argument("--elsewhere", type=Path, default=homes / "pomaria", help="another home")
    parser.add_argument(
        "--stride", type=int, default=2, help="ask for every N-th view; the whole takes 20 minutes"
    )
    parser.add_argument(
        "--senses", nargs="+", choices=SENSES, default=list(SENSES), metavar="SENSE"
    )
    parser.add_argument(
        "--more-stride", type=int, default=4, help="every N-th, changed maps and --elsewhere"
    )
    parser.add_argument(
        "--peer-views", type=int, default=12, help="ask each peer for so many, or 0"
    )
    parser.add_argument(
        "--peer-seconds", type=float, default=60.0, help="ask a peer no more after so long"
    )


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Shares of answers that are right, wrong and lost.

    By what was sensed, beside peers, by what has changed, by how far off the nearest mapped view
    is, and for another home.
    """
    for home in (args.mapped, args.asked, args.elsewhere):
        if not (home / "truth.json").is_file():
            raise NoData(f"{home}: no home with truth.json; name one, or set AFKB_DATA")
    host = PluginHost()
    with tempfile.TemporaryDirectory() as scratch:
        folder = args.map or _mapped(host, args.mapped, Path(scratch) / "map")
        bands = HeightBands.from_bytes((folder / "state" / STATE_FILE).read_bytes())
    mapped = truth_of(args.mapped)
    views, mapped_xy = true_views(host, args.asked, mapped), _places(mapped)
    elsewhere = true_views(host, args.elsewhere, mapped)
    ask, more = _asking(Localiser(bands)), args.more_stride
    senses = {name: SENSES[name] for name in args.senses}
    found = {
        name: answers(ask, views, sense, together, args.stride * together)
        for name, (sense, together) in senses.items()
    }
    return {
        "senses": {name: shares(answered) for name, answered in found.items()},
        "peers": _peers(bands, views, args.peer_views, args.peer_seconds),
        "gone": {
            f"{share:.0%}": shares(answers(_asking(_changed(bands, share)), views, depth, 1, more))
            for share in (GONE if "depth" in senses else ())
        },
        "near": by_distance(found.get("depth", []), mapped_xy),
        "elsewhere": {
            name: shares(answers(ask, elsewhere, sense, together, more * together))
            for name, (sense, together) in senses.items()
        },
    }


def _mapped(host: PluginHost, home: Path, out: Path) -> Path:
    """A map for locating alone: what things are is not asked."""
    make_map(host, Settings(uri=str(home / "bag"), out=out, detectors=("laser-bounds",)))
    return out


def _places(mapped: Truth) -> Array:
    """(N, 2) m, map frame: where its views were taken."""
    xy: Array = np.array([[v["x"], v["y"]] for v in mapped["views"]])
    return transform_xy(T_map_world(mapped), xy)


def _changed(bands: HeightBands, share: float) -> Localiser:
    return Localiser(without(bands, share, np.random.default_rng(SEED)))


def _asking(localiser: Localiser) -> Ask:
    def ask(views: Sequence[View]) -> Told:
        found = localiser.locate(asked(views, np.eye(4)))
        return found.lost, found.x, found.y, found.yaw

    return ask


def _asking_peer(peer: Peer) -> Ask:
    def ask(views: Sequence[View]) -> Told:
        found = peer(views[-1])
        return (True, math.nan, math.nan, math.nan) if found is None else (False, *found)

    return ask


def _peers(
    bands: HeightBands, views: Sequence[View], most: int, seconds: float
) -> dict[str, dict[str, Any]]:
    """What each peer answers to some views, evenly picked, in the time it has."""
    if not most:
        return {}
    stride = math.ceil(len(views) / most)
    return {
        name: shares(answers(_asking_peer(peer), views, SENSES[sense][0], 1, stride, seconds))
        for name, sense, peer in peers_in(bands)
    }


TITLES = {
    "senses": "right is within 0.25 m and 10°",
    "peers": "peers (they are never lost)",
    "gone": "depth, low things gone from the map",
    "near": "depth, by the nearest mapped view",
    "elsewhere": "views of another home",
}


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line for each of what was asked, part by part."""
    for part, rows in result.items():
        yield f"{TITLES[part]:36} {HEADER}"
        yield from lines(rows)
