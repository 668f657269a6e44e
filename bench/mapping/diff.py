"""What `afkb diff` tells of two visits to one home, both ways, against what was changed."""

from __future__ import annotations

import argparse
import json
import math
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from shutil import copytree
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.plugins.host import PluginHost
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from afkb_mapping.visits.diff import diff
from bench.detectors.data import NoData, data_folder
from bench.homes import WELL_SEEN_PIXELS
from bench.mapping.true_views import T_map_world, Truth, truth_of

BESIDE_M = 0.08
"""A node is of the smallest thing in whose box its middle lies, seen from above or this near,"""
LEVEL_M = 0.03
"""and as high or this near: a lamp's foot is no further above the top that it stands on."""
FLAT_M = 0.03
"""Nodes no higher than this are tops of furniture, whatever small thing stands at their middle; and
a top at the foot of a thing is what that stands on."""
LARGER = 2.5
"""A node longer than so many times a thing is of what holds it: a sink and not the bowl in it."""
MOVED_M = 0.10
"""Truth has things fall and settle by less."""
SAYINGS = ("moved", "vanished", "unchanged", "unknown")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Homes are folders with `bag/` and `truth.json`, in which a thing keeps its name."""
    homes = data_folder() / "homes"
    parser.add_argument("--first", type=Path, default=homes / "merom")
    parser.add_argument("--second", type=Path, default=homes / "merom-later")
    parser.add_argument("--maps", type=Path, help="folder that holds both maps, `first`, `second`")
    parser.add_argument("--stride", type=int, default=1, help="map every N-th view")


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Counts of what was told of things that had changed, and of changes that were made up."""
    for home in (args.first, args.second):
        if not (home / "truth.json").is_file():
            raise NoData(f"{home}: no home with truth.json; name one, or set AFKB_DATA")
    visits = [_Visit(home) for home in (args.first, args.second)]
    with tempfile.TemporaryDirectory() as scratch:
        folder = args.maps or Path(scratch)
        maps = [folder / name for name in ("first", "second")]
        for visit, map_ in zip(visits, maps, strict=True):
            if not map_.is_dir():
                _map(visit.home, map_, args.stride)
        updated = Path(scratch) / "updated"
        copytree(maps[0], updated)
        _map(args.second, updated, args.stride, update=True)
        return {
            "later": _judged(diff(*maps).as_json(), visits[0], visits[1]),
            "earlier": _judged(diff(*maps[::-1]).as_json(), visits[1], visits[0]),
            "updated": _judged(diff(maps[0], updated).as_json(), visits[0], visits[1]),
            "after update": _still_stated(updated, visits[0], visits[1]),
        }


def _map(home: Path, out: Path, stride: int, update: bool = False) -> None:
    settings = Settings(uri=str(home / "bag"), out=out, stride=stride, update=update)
    make_map(PluginHost(), settings)


@dataclass(frozen=True)
class _Visit:
    """One visit's truth, in the frame of its own map."""

    home: Path

    @property
    def truth(self) -> Truth:
        return truth_of(self.home)

    @property
    def T_map_world(self) -> NDArray[np.float64]:
        return T_map_world(self.truth)

    def things(self) -> dict[str, Truth]:
        return {t["name"]: t for t in self.truth["things"]}


def changed(before: _Visit, after: _Visit) -> dict[str, str]:
    """Name of each thing that is not where it was, to `moved` or `vanished`.

    Small things are told by their model: the later visit numbers them anew.
    """
    there, found = after.things(), {}
    models = {_model(name) for name in there if "#" in name}
    for name, thing in before.things().items():
        if "#" in name:
            found[name] = "moved" if _model(name) in models else "vanished"
        elif name not in there:
            found[name] = "vanished"
        elif math.dist(_middle(thing)[:2], _middle(there[name])[:2]) > MOVED_M:
            found[name] = "moved"
    return found


def _judged(told: Mapping[str, Any], before: _Visit, after: _Visit) -> dict[str, Any]:
    """What a difference says of what has changed, and says to have changed and hasn't."""
    lost = {kind: told[kind] for kind in SAYINGS[1:]}
    lost["moved"] = [{**node, **node["from"]} for node in told["moved"]]
    was, came = _Changes(before, after, before), _Changes(after, before, before)
    said: dict[str, Counter[str]] = {"furniture": Counter(), "small": Counter()}
    for thing in was.well_seen():
        said[_kind(thing)][_said_of(thing, lost, was)] += 1
    gone = [*lost["moved"], *lost["vanished"]]
    come = [*told["moved"], *told["appeared"]]
    return {
        **{kind: dict(counts) for kind, counts in said.items()},
        "invented to have gone": sum(map(was.is_of_unmoved, gone)),
        "invented to have come": sum(map(came.is_of_unmoved, come)),
        "told gone": len(gone),
        "told come": len(come),
    }


class _Changes:
    """What is elsewhere or nowhere at another visit; nodes are in the frame of a third's map."""

    def __init__(self, visit: _Visit, other: _Visit, frame: _Visit) -> None:
        self._all = sorted(visit.things().values(), key=_volume)
        self._names = changed(visit, other)
        self._T_world_map = np.linalg.inv(frame.T_map_world)

    def well_seen(self) -> list[Truth]:
        """Those of which there is something to tell."""
        changes = (t for t in self._all if t["name"] in self._names)
        return [t for t in changes if t["most_pixels"] >= WELL_SEEN_PIXELS]

    def is_of(self, thing: Truth, node: Truth) -> bool:
        """Whether a node is of this thing."""
        return self.owner(node) == thing["name"]

    def is_of_unmoved(self, node: Truth) -> bool:
        """Whether a node is of a thing that has not changed."""
        owner = self.owner(node)
        return owner is not None and owner not in self._names

    def owner(self, node: Truth) -> str | None:
        """Name of the thing that a node is of; None where there was none at this visit."""
        flat = node["size"][2] <= FLAT_M
        return next(
            (
                t["name"]
                for t in self._all
                if self._is_in(t, node) and not (flat and _kind(t) == "small")
            ),
            None,
        )

    def _is_in(self, thing: Truth, node: Truth) -> bool:
        low, high = np.array(thing["min"]), np.array(thing["max"])
        if max(node["size"][:2]) > LARGER * max(high[:2] - low[:2]):
            return False
        if node["size"][2] <= FLAT_M and node["z"] <= low[2] + LEVEL_M:
            return False
        at = self._T_world_map @ [node["x"], node["y"], node["z"], 1.0]
        slack = np.array([BESIDE_M, BESIDE_M, LEVEL_M])
        return bool(((low - slack <= at[:3]) & (at[:3] <= high + slack)).all())


def _volume(thing: Truth) -> float:
    return float(np.prod(np.array(thing["max"]) - thing["min"]))


def _kind(thing: Truth) -> str:
    return "small" if "#" in thing["name"] else "furniture"


def _said_of(thing: Truth, lost: Mapping[str, Sequence[Truth]], was: _Changes) -> str:
    for saying in SAYINGS:
        if any(was.is_of(thing, node) for node in lost[saying]):
            return saying
    return "not mapped"


def _still_stated(updated: Path, before: _Visit, after: _Visit) -> dict[str, int]:
    """Of well-seen things that have changed: how many the updated map states at either place.

    At an old place counts what is there no more; something else may have been put there.
    """
    objects = json.loads((updated / "map.json").read_text())
    nodes = [n for room in objects["rooms"] for n in room["objects"]] + objects["elsewhere"]
    seen = [n for n in nodes if n["kind"] == "ObservedEntity"]
    was, came = _Changes(before, after, before), _Changes(after, before, before)
    left = [n for n in seen if came.owner(n) is None]
    return {
        "old places": len(was.well_seen()),
        "stated still": sum(any(was.is_of(t, n) for n in left) for t in was.well_seen()),
        "new places": len(came.well_seen()),
        "stated now": sum(any(came.is_of(t, n) for n in seen) for t in came.well_seen()),
    }


def _model(name: str) -> str:
    return name.partition("#")[0]


def _middle(thing: Truth) -> NDArray[np.float64]:
    middle: NDArray[np.float64] = np.mean([thing["min"], thing["max"]], axis=0)
    return middle


def table(result: dict[str, Any]) -> Iterator[str]:
    yield f"{'what is said of well-seen things that changed':44} moved gone unch. unkn. not mapped"
    for name in ("later", "earlier", "updated"):
        for kind in ("furniture", "small"):
            said = result[name][kind]
            counts = [said.get(s, 0) for s in (*SAYINGS, "not mapped")]
            yield f"{f'{name}: {kind}':44} {''.join(f'{n:6d}' for n in counts)}"
        r = result[name]
        yield (
            f"  of {r['told gone']} told to have gone {r['invented to have gone']} have not; "
            f"of {r['told come']} told to have come {r['invented to have come']}"
        )
    r = result["after update"]
    yield (
        f"after --update: {r['stated still']} of {r['old places']} left places still have a node, "
        f"{r['stated now']} of {r['new places']} new ones have one"
    )
