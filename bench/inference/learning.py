"""Whether learning from a few homes of one kind makes others of that kind better understood.

    python -m bench.inference learning [--rooms matterport_train.csv] [--homes 0 1 3 10 40] [--json]

Homes of the table are parted by building: some are learnt as `afkb ontology learn` does, an
extension of tables of homes; rooms of fifteen others are then told, from affordances alone (each
thing by the evidence class that a typical one of its category counts for) and from categories, too.
What is learnt from 0 homes is the ontology as it is. Its own counts tell of rooms in HM3D first.
Several draws of the homes, with their spread.
"""

from __future__ import annotations

import argparse
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from afkb.csv_rows import csv_text
from afkb.figures import Names
from afkb.figures.reading import SeenRoom, Shape, seen_rooms
from afkb.inference import Network
from afkb.knowledge import AfNet
from afkb.knowledge.own_homes import classes_of
from afkb.learning.extension import write_extension
from afkb.ontology.bundled import bundled_ontology
from bench.detectors.data import NoData, data_folder

HELD_OUT, DRAWS = 15, 3
LEARNT = (0, 1, 3, 10, 40)
SEED = 1
LEAST_P = 1e-4
"""The least a true room is held for in a log loss: no single surprise decides the mean."""
Told = tuple[str, str, dict[str, int]]
"""Building, room category and things by category, under the ontology's names."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The table, how many homes are learnt, and how often they are drawn."""
    rooms = data_folder() / "rooms"
    parser.add_argument("--rooms", type=Path, default=rooms / "matterport_train.csv")
    parser.add_argument("--homes", type=int, nargs="+", default=list(LEARNT))
    parser.add_argument("--draws", type=int, default=DRAWS)


def run(args: argparse.Namespace) -> list[dict[str, Any]]:
    """A row per number of homes: accuracy and mean log loss, with and without categories."""
    if not args.rooms.is_file():
        raise NoData(f"{args.rooms}: no such table of rooms; name it with --rooms")
    rooms = told_rooms(args.rooms)
    buildings = sorted({building for building, _, _ in rooms})
    rng = np.random.default_rng(SEED)
    draws = [rng.permutation(buildings).tolist() for _ in range(args.draws)]
    found: dict[int, list[dict[str, float]]] = {number: [] for number in args.homes}
    for draw in draws:
        held_out = [room for room in rooms if room[0] in draw[:HELD_OUT]]
        for number in args.homes:
            learnt = draw[HELD_OUT : HELD_OUT + number]
            found[number].append(scores(network_after(rooms, learnt), held_out))
    return [{"homes": number, **_with_spread(some)} for number, some in found.items()]


def told_rooms(path: Path) -> list[Told]:
    """The rows of a Matterport table whose room the ontology names."""
    names, source = Names.load(bundled_ontology().parent / "tables"), Shape.MATTERPORT.value
    return [
        (room.building, category, _ours(room, names, source))
        for room in seen_rooms([path], Shape.MATTERPORT)
        if (category := names.rooms.find(source, room.category)) is not None
    ]


def _ours(room: SeenRoom, names: Names, source: str) -> dict[str, int]:
    things: Counter[str] = Counter()
    for called, number in room.things.items():
        if (name := names.categories.find(source, called)) is not None:
            things[name] += number
    return dict(things)


def network_after(rooms: Sequence[Told], learnt: Sequence[str]) -> Network:
    """The network with an extension that brings these homes."""
    if not learnt:
        return Network.compile(AfNet())
    rows = [
        (building, f"r{i}", category, "|".join(f"{n}:{k}" for n, k in things.items()))
        for i, (building, category, things) in enumerate(rooms)
        if building in learnt
    ]
    with tempfile.TemporaryDirectory() as scratch:
        table, extension = Path(scratch) / "homes.csv", Path(scratch) / "learnt.yaml"
        table.write_text(csv_text(("building", "room", "category", "objects"), rows))
        write_extension([table], extension)
        network = Network.compile(AfNet(extensions=[extension]))
        _ = network.contents_network
    return network


def scores(network: Network, rooms: Sequence[Told]) -> dict[str, float]:
    """Accuracy and mean log loss (nats) of held-out rooms, without and with categories."""
    kb = network.knowledge_base
    counted_for = {
        name: classes_of(category, kb.evidence_classes, kb.features)
        for name, category in kb.categories.items()
    }
    sums: Counter[str] = Counter()
    for _, truth, things in rooms:
        counts: Counter[str] = Counter()
        for name, number in things.items():
            counts.update(dict.fromkeys(counted_for[name], number))
        for by, belief in (
            ("affordances", network.room_posterior(counts)),
            ("categories", network.room_posterior({}, things)),
        ):
            best = max((r for r in belief if r != "UnknownRoom"), key=lambda r: belief[r])
            sums[f"{by}: right"] += best == truth
            sums[f"{by}: log loss"] -= float(np.log(max(belief[truth], LEAST_P)))
    return {what: total / len(rooms) for what, total in sorted(sums.items())}


def _with_spread(draws: Sequence[dict[str, float]]) -> dict[str, float]:
    """Mean and standard deviation over the draws."""
    told: dict[str, float] = {}
    for what in draws[0]:
        values = [draw[what] for draw in draws]
        told[what] = round(float(np.mean(values)), 4)
        told[f"{what}, sd"] = round(float(np.std(values)), 4)
    return told


def table(result: list[dict[str, Any]]) -> Iterator[str]:
    """A line per number of homes learnt."""
    yield "homes learnt   affordances: right   log loss      categories: right   log loss"
    for row in result:
        said = "   ".join(
            f"{row[f'{by}: {what}']:.3f} ± {row[f'{by}: {what}, sd']:.3f}"
            for by in ("affordances", "categories")
            for what in ("right", "log loss")
        )
        yield f"{row['homes']:12}   {said}"
