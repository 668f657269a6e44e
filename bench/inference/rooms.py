"""What rooms are for, by what is seen in them: tables of labelled rooms, building by building.

    python -m bench.inference rooms                            folds of the viewpoints; whole rooms
    python -m bench.inference rooms FILE --train FILE [--json]  a posterior for each row of FILE

A table is a CSV of rooms or viewpoints with the things in each (`afkb ontology count` knows the
shapes). `affordances`: each thing is known by what it affords, its scale and the height of its top
alone; `structural`: without what its material affords; `categories`: by its category. Figures come
from the training rows, drawn towards those that the ontology's counts of whole rooms tell, of other
buildings. In folds, all of a building's rows are judged by the other buildings. `bayes` and
`forest`: a Bernoulli naive Bayes and a random forest on categories, as peers.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.figures import Figures, Names
from afkb.inference.contents import ContentsNetwork
from afkb.inference.holdings import Holdings, kinds_together
from afkb.inference.kinds import Kinds
from afkb.knowledge import AfNet
from bench.calibration.measures import expected_calibration_error
from bench.detectors.data import NoData, data_folder
from bench.inference.adapted import in_rooms_about
from bench.inference.room_peers import peer_posteriors
from bench.inference.tables import TABLES, RoomRow, Table, figures_of, read_table, stated_by

SEVEN = ("Bathroom", "Bedroom", "DiningRoom", "Hallway", "Kitchen", "LivingRoom", "Office")
"""The room categories of viewpoints that are judged; lounges and family rooms are living rooms.
Stairs, porches and entrances are left out, which nobody tells apart from a hall by its things."""
FOLDS = 5
MANY = 5
"""From so many things on a row is judged apart, too: with fewer, often nobody could tell."""
EVIDENCE = ("structural", "affordances", "categories")


@dataclass(frozen=True)
class Trained:
    """A network for each kind of evidence, and what it calls the categories."""

    rooms: tuple[str, ...]
    networks: Mapping[str, ContentsNetwork]
    called: Mapping[str, Mapping[str, str]]

    @classmethod
    def on(cls, train: Table, rooms: Sequence[str], kb: AfNet, others: Figures | None) -> Trained:
        """The networks of a table's rows."""
        own = figures_of(train)
        told = in_rooms_about(own, others, rooms) if others else own.in_rooms(0)
        stated = stated_by(own, (f for f in told if f.room in rooms), rooms, kb)
        holdings = Holdings.compile(stated)
        networks, called = {}, {}
        for evidence in EVIDENCE:
            kinds = Kinds(kb, with_material=evidence == "affordances").of
            names = {c: c if evidence == "categories" else kinds[c] for c in holdings.categories}
            called[evidence] = names
            held = (
                holdings
                if evidence == "categories"
                else kinds_together(holdings, [names[c] for c in holdings.categories])
            )
            networks[evidence] = ContentsNetwork.of_holdings(held, stated)
        return cls(tuple(rooms), networks, called)

    def posterior(self, row: RoomRow, evidence: str) -> NDArray[np.float64]:
        """(R,) probabilities of the rooms."""
        network, called = self.networks[evidence], self.called[evidence]
        found: dict[str, int] = {}
        for category, number in row.things.items():
            if category in called:
                found[called[category]] = found.get(called[category], 0) + number
        weights = network.prior * network.likelihood(found).sum(axis=1)
        return np.asarray(weights / weights.sum())


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The tables; without any, those at hand."""
    parser.add_argument("file", nargs="?", type=Path, help="rows to give a posterior to")
    parser.add_argument("--train", type=Path, help="rows to count")
    parser.add_argument("--folds", type=int, default=FOLDS)
    parser.add_argument("--no-peers", action="store_true", help="leave the peers out")


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Posteriors of a file's rows, or scores of folds."""
    if args.file:
        return _of_file(args)
    folder = data_folder() / "rooms"
    names = Names.load(TABLES)
    table = read_table(folder / "matterport_train.csv", names)
    rows = table.where(lambda row: row.room in SEVEN and row.told > 0)
    whole = read_table(folder / "hm3d_regions.csv", names)
    labelled = whole.where(lambda row: bool(row.room) and row.told > 0)
    kinds_of_rooms = sorted({row.room for row in labelled.rows})
    return {
        "viewpoints": _folds(rows, SEVEN, args, whole_rooms()),
        "whole_rooms": _folds(labelled, kinds_of_rooms, args, None),
    }


def whole_rooms() -> Figures:
    """The ontology's counts of whole rooms, of buildings that no table of viewpoints has."""
    return AfNet().figures.of("hm3d")


def _of_file(args: argparse.Namespace) -> dict[str, Any]:
    names, kb = Names.load(TABLES), AfNet()
    table = read_table(args.file, names)
    if args.train is None:
        raise NoData("name the rows to count with --train FILE")
    train = read_table(args.train, names)
    rooms = [room for room in SEVEN if any(row.room == room for row in train.rows)]
    others = None if train.unit_weight == 1.0 else whole_rooms()
    trained = Trained.on(train.where(lambda row: row.room in rooms), rooms, kb, others)
    posteriors = {e: np.array([trained.posterior(r, e) for r in table.rows]) for e in EVIDENCE}
    truth = np.array([row.room for row in table.rows])
    judged = np.isin(truth, rooms)
    many = np.array([row.told >= MANY for row in table.rows])
    scored = {
        e: scores(p[judged], truth[judged], rooms, many[judged])
        for e, p in posteriors.items()
        if judged.any()
    }
    return {
        "rows": [
            {"building": row.building, "row": row.number}
            | {
                e: {room: round(float(v), 6) for room, v in zip(rooms, p[i], strict=True)}
                for e, p in posteriors.items()
            }
            for i, row in enumerate(table.rows)
        ],
        "scores": scored,
    }


def _folds(
    table: Table, rooms: Sequence[str], args: argparse.Namespace, others: Figures | None
) -> dict[str, Any]:
    kb = AfNet()
    truth = np.array([row.room for row in table.rows])
    many = np.array([row.told >= MANY for row in table.rows])
    found = {e: np.zeros((len(truth), len(rooms))) for e in EVIDENCE}
    own_fold = np.zeros(len(truth), dtype=int)
    for fold in range(args.folds):
        train, held_out = table.split(fold, args.folds)
        own_fold[held_out] = fold
        trained = Trained.on(train, rooms, kb, others)
        for evidence in EVIDENCE:
            found[evidence][held_out] = [
                trained.posterior(table.rows[i], evidence) for i in held_out
            ]
        if not args.no_peers:
            peers = peer_posteriors(table, train, held_out, rooms)
            for name, posterior in peers.items():
                found.setdefault(name, np.zeros((len(truth), len(rooms))))[held_out] = posterior
    buildings = len({row.building for row in table.rows})
    return {
        "rows": len(truth),
        "buildings": buildings,
        "rooms": list(rooms),
        "scores": {
            name: scores(p, truth, rooms, many) | {"spread": _spread(p, truth, rooms, own_fold)}
            for name, p in found.items()
        },
    }


def _spread(
    p: NDArray[np.float64],
    truth: NDArray[np.str_],
    rooms: Sequence[str],
    fold: NDArray[np.int_],
) -> float:
    """Standard deviation of the folds' accuracies."""
    right = np.array(rooms)[p.argmax(axis=1)] == truth
    return float(np.std([right[fold == f].mean() for f in np.unique(fold)]))


def scores(
    p: NDArray[np.float64],
    truth: NDArray[np.str_],
    rooms: Sequence[str],
    many: NDArray[np.bool_],
) -> dict[str, Any]:
    """Accuracy, calibration and confusion of posteriors (N, R); `many` (N,): enough to tell by."""
    best = np.array(rooms)[p.argmax(axis=1)]
    right = (best == truth).astype(np.float64)
    one_hot = (truth[:, None] == np.array(rooms)[None]).astype(np.float64)
    own = np.maximum((p * one_hot).sum(axis=1), 1e-12)
    return {
        "accuracy": float(right.mean()),
        "accuracy_many": float(right[many].mean()) if many.any() else None,
        "balanced": float(np.mean([right[truth == r].mean() for r in rooms if (truth == r).any()])),
        "brier": float(((p - one_hot) ** 2).sum(axis=1).mean()),
        "log_loss": float(-np.log(own).mean()),
        "ece": expected_calibration_error(p.max(axis=1), right),
        "confusion": {
            r: {b: int(((truth == r) & (best == b)).sum()) for b in rooms} for r in rooms
        },
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line per kind of evidence, and where rooms are taken for others."""
    if "rows" in result:
        yield from _rows_as_csv(result)
        return
    for what, folds in result.items():
        name = what.replace("_", " ")
        yield f"{name}: {folds['rows']} rows of {folds['buildings']} buildings"
        for evidence, score in folds["scores"].items():
            yield _line(evidence, score)
        yield from _confusion(folds["scores"]["categories"]["confusion"])


def _line(evidence: str, score: dict[str, Any]) -> str:
    spread = f" ± {score['spread']:.3f}" if "spread" in score else ""
    return (
        f"{evidence:>12}  accuracy {score['accuracy']:.3f}{spread}, with {MANY} things or more "
        f"{score['accuracy_many'] or math.nan:.3f}, balanced {score['balanced']:.3f}, "
        f"Brier {score['brier']:.3f}, log loss {score['log_loss']:.3f}, ECE {score['ece']:.3f}"
    )


def _confusion(confusion: dict[str, dict[str, int]]) -> Iterator[str]:
    rooms = list(confusion)
    yield "by categories, true room / taken for"
    yield " " * 14 + "".join(f"{room[:10]:>11}" for room in rooms)
    for room, taken in confusion.items():
        yield f"{room[:13]:>14}" + "".join(f"{taken[other]:>11}" for other in rooms)


def _rows_as_csv(result: dict[str, Any]) -> Iterator[str]:
    for row in result["rows"]:
        best = "  ".join(
            f"{e}: " + " ".join(f"{room} {p:.3f}" for room, p in sorted(row[e].items()))
            for e in EVIDENCE
        )
        yield f"{row['building']},{row['row']}  {best}"
    for evidence, score in result["scores"].items():
        yield _line(evidence, score)
