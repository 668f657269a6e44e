"""How well figures from some homes tell what is in the rooms of others.

    python -m bench.figures [COUNTS] [--source hm3d] [--folds 5] [--weights | --transfer] [--json]

Buildings are split into folds by a hash of their name; each fold's rooms are predicted from the
other folds. A room is one yes-or-no answer per category of which the source has a name. Log loss
(nats) and Brier score are summed over a room's categories and averaged over rooms, so that they
don't shrink with the number of categories; the spread is the standard deviation over folds. `more`
is by how much a predictor's loss exceeds the first one's, fold by fold.

`smoothed`: P(category | room category) as afkb gives it of the judged source. `unsmoothed`:
successes by trials, kept off 0 and 1 by CLIP (how often that saved it from an infinite loss is
told). `base rate`: the rate over all rooms, whatever their category. `pooled`: smoothed, with
rooms and viewpoints of all real sources in one sum. `--weights` compares prior weights instead.
`--transfer` hides the room categories of the judged source, to see how well viewpoints stand in
for rooms that nobody counted: `shifted` is what afkb gives then, `viewpoints` their rates as they
are.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import sys
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from afkb.figures import Figures, read_counts
from afkb.figures.counts import Building, Counts, RoomTally
from afkb.figures.smoothing import ROOM_WEIGHT

COUNTS = Path(__file__).parents[1] / "ontology" / "counts"
CLIP = 1e-4
WEIGHTS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)
VIEWPOINTS = "matterport"
ELSEWHERE = "Elsewhere"
Predict = Callable[[str, str], float]


@dataclass(frozen=True)
class Asked:
    """The room categories and categories that are judged."""

    rooms: frozenset[str]
    categories: tuple[str, ...]

    @classmethod
    def of(cls, counts: Counts, sources: set[str]) -> Asked:
        """What all of these sources have."""
        rooms = [
            {r for (name, _), b in counts.buildings.items() if name == source for r in b.rooms}
            for source in sources
        ]
        categories = [counts.sources[source].categories for source in sources]
        return cls(
            frozenset(set.intersection(*rooms)), tuple(sorted(frozenset.intersection(*categories)))
        )


def fold_of(building: str, folds: int) -> int:
    """The fold of a building: the same on every machine."""
    return int(hashlib.sha256(building.encode()).hexdigest(), 16) % folds


class Score:
    """Losses of one predictor on one fold, summed."""

    def __init__(self) -> None:
        self.log_loss = self.brier = 0.0
        self.rooms = self.surprises = 0

    def add(self, p: float, yes: int, rooms: int) -> None:
        """Judge a probability on rooms, of which some hold it."""
        clipped = min(max(p, CLIP), 1 - CLIP)
        self.log_loss -= yes * math.log(clipped) + (rooms - yes) * math.log1p(-clipped)
        self.brier += yes * (1 - p) ** 2 + (rooms - yes) * p**2
        self.surprises += yes if p <= 0 else rooms - yes if p >= 1 else 0


def judge(counts: Counts, source: str, held_out: set[str], predict: Predict, asked: Asked) -> Score:
    """The predictor's losses on the held-out buildings, over these rooms and categories."""
    score = Score()
    for (name, building), content in counts.buildings.items():
        if name != source or building not in held_out:
            continue
        for room in asked.rooms & content.rooms.keys():
            tally = content.rooms[room]
            score.rooms += tally.rooms
            for category in asked.categories:
                yes = tally.holding.get(category, 0)
                score.add(predict(category, room), yes, tally.rooms)
    return score


def predictors(counts: Counts, source: str, weights: bool) -> dict[str, Predict]:
    """What is compared, by name."""
    own = counts.of([source])
    if weights:
        return {f"prior weight {w:g}": _in_room(Figures(own, room_weight=w)) for w in WEIGHTS}
    alone, pooled = Figures(own), Figures(counts, rooms_first=False)

    def unsmoothed(category: str, room: str) -> float:
        figure = alone.object_in_room(category, room)
        return figure.successes / figure.trials if figure.trials else alone.base_rate(category)

    return {
        "smoothed": _in_room(alone),
        "unsmoothed": cache(unsmoothed),
        "base rate": cache(lambda category, room: alone.base_rate(category)),
        "pooled": _in_room(pooled),
    }


def transferred(counts: Counts, source: str) -> dict[str, Predict]:
    """What is compared where the source's rooms have lost their categories."""
    own, hidden = Figures(counts.of([source])), dict(counts.buildings)
    for key, building in counts.buildings.items():
        if key[0] == source:
            pooled = RoomTally()
            for tally in building.rooms.values():
                pooled = pooled.plus(tally)
            hidden[key] = Building({ELSEWHERE: pooled})
    return {
        "shifted": _in_room(Figures(replace(counts, buildings=hidden))),
        "viewpoints": _in_room(Figures(counts.of([VIEWPOINTS]))),
        "base rate": cache(lambda category, room: own.base_rate(category)),
        "smoothed": _in_room(own),
    }


def _in_room(figures: Figures) -> Predict:
    return cache(lambda category, room: figures.object_in_room(category, room).p)


def evaluate(
    counts: Counts, source: str, folds: int, weights: bool, transfer: bool
) -> dict[str, object]:
    asked = Asked.of(counts, {source, VIEWPOINTS} if transfer else {source})
    buildings = sorted(name for origin, name in counts.buildings if origin == source)
    scores: defaultdict[str, list[Score]] = defaultdict(list)
    for fold in range(folds):
        held_out = {b for b in buildings if fold_of(b, folds) == fold}
        if not held_out or len(held_out) == len(buildings):
            continue
        known = counts.without(held_out)
        compared = transferred(known, source) if transfer else predictors(known, source, weights)
        for name, predict in compared.items():
            scores[name].append(judge(counts, source, held_out, predict, asked))
    return {
        "source": source,
        "buildings": len(buildings),
        "rooms": sum(s.rooms for s in next(iter(scores.values()))),
        "categories": len(asked.categories),
        "folds": folds,
        "prior_weight": ROOM_WEIGHT,
        "per_room": {
            name: _summary(per_fold, next(iter(scores.values())))
            for name, per_fold in scores.items()
        },
    }


def _summary(scores: list[Score], first: list[Score]) -> dict[str, object]:
    """Means over rooms, spreads over folds, and the same of the difference from the first."""
    rooms = np.array([s.rooms for s in scores])
    result: dict[str, object] = {}
    for what in ("log_loss", "brier"):
        total, least = (np.array([getattr(s, what) for s in some]) for some in (scores, first))
        result[what] = round(float(total.sum() / rooms.sum()), 3)
        result[f"{what}_spread"] = round(float((total / rooms).std()), 3)
        result[f"{what}_more"] = round(float((total - least).sum() / rooms.sum()), 3)
        result[f"{what}_more_spread"] = round(float(((total - least) / rooms).std()), 3)
    return {**result, "impossible_but_seen": sum(s.surprises for s in scores)}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("counts", nargs="?", type=Path, default=COUNTS)
    parser.add_argument("--source", default="hm3d")
    parser.add_argument("--folds", type=int, default=5)
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--weights", action="store_true")
    which.add_argument("--transfer", action="store_true")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    counts = read_counts(arguments.counts)
    result = evaluate(
        counts, arguments.source, arguments.folds, arguments.weights, arguments.transfer
    )
    if arguments.json:
        json.dump(result, sys.stdout, indent=1)
        return 0
    for key, value in result.items():
        if key != "per_room":
            sys.stdout.write(f"{key}: {value}\n")
    for name, row in result["per_room"].items():
        cells = "  ".join(f"{what} {value}" for what, value in row.items())
        sys.stdout.write(f"{name:>18}  {cells}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
