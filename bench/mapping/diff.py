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
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.run import make_map
from afkb_mapping.run_record import Settings
from afkb_mapping.visits.diff import diff
from bench.detectors.data import NoData, data_folder
from bench.homes import WELL_SEEN_PIXELS

Truth = Mapping[str, Any]

BESIDE_M = 0.08
"""A node is of a thing if its middle lies in the thing's box, or this near."""
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
        return dict(json.loads((self.home / "truth.json").read_text()))

    @property
    def T_map_world(self) -> NDArray[np.float64]:
        first = self.truth["views"][0]
        return np.linalg.inv(T_from_xy_yaw(first["x"], first["y"], first["yaw"]))

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
    changes, things = changed(before, after), before.things()
    said: dict[str, Counter[str]] = {"furniture": Counter(), "small": Counter()}
    for name in changes:
        thing = things[name]
        if thing["most_pixels"] < WELL_SEEN_PIXELS:
            continue
        kind = "small" if "#" in name else "furniture"
        said[kind][_said_of(thing, lost, before.T_map_world)] += 1
    unmoved = [t for n, t in things.items() if n not in changes]
    gone = [*lost["moved"], *lost["vanished"]]
    come = [*told["moved"], *told["appeared"]]
    T = before.T_map_world
    moved_there = _changed_things(after, before)
    return {
        **{kind: dict(counts) for kind, counts in said.items()},
        "invented": sum(
            _is_in(unmoved, n, T) and not _is_of_changed(n, changes, things, T) for n in gone
        ),
        "invented to have come": sum(
            _is_in(unmoved, n, T) and not _is_in(moved_there, n, T) for n in come
        ),
        "told gone": len(gone),
        "told come": len(come),
    }


def _changed_things(visit: _Visit, other: _Visit) -> list[Truth]:
    return [visit.things()[name] for name in changed(visit, other)]


def _is_of_changed(
    node: Truth, changes: Mapping[str, str], things: Mapping[str, Truth], T: NDArray[np.float64]
) -> bool:
    return _is_in([things[name] for name in changes], node, T)


def _said_of(thing: Truth, lost: Mapping[str, Sequence[Truth]], T: NDArray[np.float64]) -> str:
    for saying in SAYINGS:
        if any(_is_in([thing], node, T) for node in lost[saying]):
            return saying
    return "not mapped"


def _is_in(things: Sequence[Truth], node: Truth, T_map_world: NDArray[np.float64]) -> bool:
    """Whether a node's middle, map frame, lies in the box of one of some things."""
    at = np.linalg.inv(T_map_world) @ [node["x"], node["y"], node["z"], 1.0]
    return any(
        all(t["min"][i] - BESIDE_M <= at[i] <= t["max"][i] + BESIDE_M for i in range(3))
        for t in things
    )


def _still_stated(updated: Path, before: _Visit, after: _Visit) -> dict[str, int]:
    """Of well-seen things that have changed: how many the updated map states at either place."""
    objects = json.loads((updated / "map.json").read_text())
    nodes = [n for room in objects["rooms"] for n in room["objects"]] + objects["elsewhere"]
    seen = [n for n in nodes if n["kind"] == "ObservedEntity"]
    T = before.T_map_world
    old = [t for t in _changed_things(before, after) if t["most_pixels"] >= WELL_SEEN_PIXELS]
    new = [t for t in _changed_things(after, before) if t["most_pixels"] >= WELL_SEEN_PIXELS]
    return {
        "old places": len(old),
        "stated still": sum(_states(seen, t, T) for t in old),
        "new places": len(new),
        "stated now": sum(_states(seen, t, T) for t in new),
    }


def _states(nodes: Sequence[Truth], thing: Truth, T: NDArray[np.float64]) -> bool:
    return any(_is_in([thing], node, T) for node in nodes)


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
            f"  of {r['told gone']} told to have gone {r['invented']} have not; "
            f"of {r['told come']} told to have come {r['invented to have come']}"
        )
    r = result["after update"]
    yield (
        f"after --update: {r['stated still']} of {r['old places']} left places still have a node, "
        f"{r['stated now']} of {r['new places']} new ones have one"
    )
