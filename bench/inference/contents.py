"""What else a room holds: each category hidden in turn and predicted from the rest of the room.

    python -m bench.inference contents [FILE] [--names own|afkb] [--folds 5] [--no-peers] [--json]

A table is a CSV of whole rooms with their things. Rooms with three things or more are asked;
judged are the categories that at least 40 of them hold. The network is compiled, fold by fold, from
the buildings of the others. `own`: under the table's own names, each a category; `afkb`: under
those of the ontology. Brier skill is over the category's rate in the training buildings, whatever
the room. `constant`: that rate. `regression`: a logistic regression per category on which others
are there, as a peer.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import roc_auc_score

from afkb.figures import Names
from afkb.inference.contents import ContentsNetwork
from afkb.knowledge import AfNet
from bench.calibration.measures import expected_calibration_error
from bench.detectors.data import data_folder
from bench.inference.tables import TABLES, RoomRow, Table, figures_of, read_table, stated_by

LEAST_THINGS, LEAST_ROOMS, FOLDS = 3, 40, 5
UNLABELLED = "Unlabelled"
"""The room category of rooms that have none: one more kind of room."""
NO_CATEGORY = frozenset({"unknown"})
"""Names by which a table says that it has no name."""
PENALTY = 0.1
"""Inverse strength of the regression's penalty: of 0.03, 0.1 and 0.3 the best on these folds."""
SKILLS, AUC = (0.1, 0.2), 0.8

Floats = NDArray[np.float64]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The table of rooms."""
    parser.add_argument("file", nargs="?", type=Path, help="table of whole rooms")
    parser.add_argument("--names", choices=("own", "afkb"), default="own")
    parser.add_argument("--folds", type=int, default=FOLDS)
    parser.add_argument("--no-peers", action="store_true", help="leave the regression out")


def run(args: argparse.Namespace) -> dict[str, Any]:
    """Scores of the predictors over all categories, and each category's."""
    path = args.file or data_folder() / "rooms" / "hm3d_regions.csv"
    table = asked(read_table(path, Names.load(TABLES) if args.names == "afkb" else None))
    holding = Counter(category for row in table.rows for category in row.things)
    judged = sorted(category for category, rooms in holding.items() if rooms >= LEAST_ROOMS)
    there = np.array([[c in row.things for c in judged] for row in table.rows], dtype=np.float64)
    found = {name: np.zeros_like(there) for name in ("network", "constant", "regression")}
    if args.no_peers:
        del found["regression"]
    causes = 0
    for fold in range(args.folds):
        train, held_out = table.split(fold, args.folds)
        network = network_of_rows(train)
        causes += len(network.causes)
        rows = [table.rows[i] for i in held_out]
        found["network"][held_out] = hidden_in_turn(network, rows, judged)
        found["constant"][held_out] = [
            np.mean([c in row.things for row in train.rows]) for c in judged
        ]
        if not args.no_peers:
            found["regression"][held_out] = regressed(train, rows, judged)
    base = found["constant"]
    return {
        "rooms": len(table.rows),
        "categories": len(judged),
        "causes": causes / args.folds,
        "scores": {name: scores(p, base, there) for name, p in found.items()},
        "by_category": by_category(judged, found["network"], base, there),
    }


def asked(table: Table) -> Table:
    """Rooms with enough things, each of some category."""
    rows = tuple(
        replace(row, room=row.room if known(row) else UNLABELLED, things=named(row))
        for row in table.rows
        if row.told >= LEAST_THINGS
    )
    return Table(rows, table.unit_weight)


def known(row: RoomRow) -> bool:
    """Whether the table has one category for the room."""
    return bool(row.room) and not row.room.startswith(("Tie:", "Unknown"))


def named(row: RoomRow) -> Counter[str]:
    """The things that have a name."""
    return Counter({c: n for c, n in row.things.items() if c not in NO_CATEGORY})


def network_of_rows(train: Table) -> ContentsNetwork:
    """Compiled from what the rows tell, as from an ontology."""
    own = figures_of(train)
    rooms = sorted({row.room for row in train.rows})
    return ContentsNetwork.compile(stated_by(own, own.in_rooms(3), rooms, AfNet()))


def hidden_in_turn(
    network: ContentsNetwork, rows: Sequence[RoomRow], judged: Sequence[str]
) -> Floats:
    """(N, judged) P(there | all else in the room, its category unknown)."""
    even = np.repeat(network.prior[:, None], len(network.shares), axis=1)
    p = []
    for row in rows:
        found = {c: n for c, n in row.things.items() if c in network.categories}
        hidden = network.each_hidden(found, even)
        p.append([hidden.get(c, 0.0) for c in judged])
    return np.array(p)


def regressed(train: Table, rows: Sequence[RoomRow], judged: Sequence[str]) -> Floats:
    """(N, judged) of one logistic regression per category."""
    columns = sorted({c for row in train.rows for c in row.things})
    x, asked_x = (np.array([[c in row.things for c in columns] for row in some], dtype=np.float64)
                  for some in (train.rows, rows))  # fmt: skip
    p = np.zeros((len(rows), len(judged)))
    for k, category in enumerate(judged):
        others = [i for i, c in enumerate(columns) if c != category]
        y = np.array([category in row.things for row in train.rows])
        if y.any():
            model = LogisticRegression(C=PENALTY, solver="liblinear", max_iter=300)
            p[:, k] = model.fit(x[:, others], y).predict_proba(asked_x[:, others])[:, 1]
    return p


def scores(p: Floats, base: Floats, there: Floats) -> dict[str, Any]:
    """How many categories are told how well, and the calibration of all together."""
    skill = skills(p, base, there)
    auc = np.array([roc_auc_score(there[:, k], p[:, k]) for k in range(p.shape[1])])
    return {
        **{f"skill_above_{least}": int((skill > least).sum()) for least in SKILLS},
        f"auc_above_{AUC}": int((auc > AUC).sum()),
        "mean_skill": float(skill.mean()),
        "mean_auc": float(auc.mean()),
        "ece": expected_calibration_error(p.ravel(), there.ravel(), 20),
        "brier_per_room": float(((p - there) ** 2).sum(axis=1).mean()),
    }


def skills(p: Floats, base: Floats, there: Floats) -> Floats:
    """(categories,) 1 - Brier / Brier of the rates in the training buildings."""
    return np.asarray(1 - ((p - there) ** 2).mean(axis=0) / ((base - there) ** 2).mean(axis=0))


def by_category(
    judged: Sequence[str], p: Floats, base: Floats, there: Floats
) -> Mapping[str, dict[str, float]]:
    """Skill and number of rooms of each category, the most skilled first."""
    skill = skills(p, base, there)
    order = np.argsort(-skill)
    return {judged[k]: {"rooms": float(there[:, k].sum()), "skill": float(skill[k])} for k in order}


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line per predictor, and the best and worst told categories."""
    yield (
        f"{result['rooms']} rooms, {result['categories']} categories, "
        f"{result['causes']:.0f} co-occurrences in the network"
    )
    for name, score in result["scores"].items():
        told = ", ".join(f"skill > {least}: {score[f'skill_above_{least}']}" for least in SKILLS)
        yield (
            f"{name:>11}  {told}, AUC > {AUC}: {score[f'auc_above_{AUC}']}, mean skill "
            f"{score['mean_skill']:.3f}, mean AUC {score['mean_auc']:.3f}, "
            f"ECE {score['ece']:.4f}, Brier per room {score['brier_per_room']:.3f}"
        )
    names = list(result["by_category"])
    yield f"told best: {', '.join(names[:12])}"
    yield f"told worst: {', '.join(names[-12:])}"
