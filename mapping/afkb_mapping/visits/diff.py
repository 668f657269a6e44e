"""What has changed between two visits: moved, vanished, appeared, unchanged, and not looked at."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from afkb.store import load
from afkb.store.shapes import Json
from afkb_mapping.memory.memory import Memory
from afkb_mapping.memory.storing import memory_of
from afkb_mapping.visits.alignment import T_first_second, is_continued_by
from afkb_mapping.visits.body_points import body_points
from afkb_mapping.visits.clock import HOURS_BETWEEN, SECONDS_PER_HOUR
from afkb_mapping.visits.looked_at import Verdict, verdicts
from afkb_mapping.visits.things import (
    ComparedThing,
    is_alike,
    is_same_place,
    same_belief,
    things_of,
)

Array = NDArray[np.float64]

FAR_M = 2.0
"""A thing that is found this far away is half as alike as one beside its place: most are shoved
about near where they stood, and what two visits say of one thing's category differs by a third."""
APART = 1e3


@dataclass(slots=True, eq=False)
class Difference:
    """Nodes in the frame of the first map, by what has become of them.

    `moved`: pairs of a node of the first map and the same thing in the second. `unknown`: seen at
    one visit in a place that the other one did not look at.
    """

    moved: list[tuple[Json, Json]] = field(default_factory=list)
    vanished: list[Json] = field(default_factory=list)
    appeared: list[Json] = field(default_factory=list)
    unchanged: list[Json] = field(default_factory=list)
    unknown: list[Json] = field(default_factory=list)

    def as_json(self) -> dict[str, object]:
        """The shape of `afkb diff --json`."""
        moved = [{**after, "from": _at(before), "to": _at(after)} for before, after in self.moved]
        return {
            "moved": moved,
            "vanished": self.vanished,
            "appeared": self.appeared,
            "unchanged": self.unchanged,
            "unknown": self.unknown,
        }


def _at(node: Json) -> Json:
    return {key: node[key] for key in ("id", "x", "y", "z", "yaw", "room")}


def diff(first: Path, second: Path, T: Array | None = None) -> Difference:
    """What the second map, of a later visit, shows changed since the first one.

    `T` (4, 4), planar: from its frame to the first one's, if that is known. Raises `MapError` for
    what is no map, has no memory, or can't be located in the first one.
    """
    old, new = load(first), load(second)
    before, after = memory_of(first), memory_of(second)
    seen_from, seconds = -math.inf, HOURS_BETWEEN * SECONDS_PER_HOUR
    if is_continued_by(before, after):
        end = max(p.stamp for p in before.passed)
        after = after.without_visits(len(before.visits))
        seen_from, T = end, np.eye(4)
        seconds = min(p.stamp for p in after.passed) - end
    elif T is None:
        T = T_first_second(first, second, after)
    return compared(
        list(things_of(old, np.eye(4))),
        [t for t in things_of(new, T) if t.last_seen > seen_from],
        before,
        after,
        T,
        seconds,
    )


def compared(
    old: Sequence[ComparedThing],
    new: Sequence[ComparedThing],
    before: Memory,
    after: Memory,
    T: Array,
    seconds: float,
) -> Difference:
    """The difference of two visits' things, which are in one frame.

    `before`, `after`: what the visits saw; `T` (4, 4): from the frame of the later visit's views.
    """
    stayed_old, stayed_new = _stayed(old, new)
    difference = Difference(unchanged=[new[j].node for j in sorted(stayed_new)])
    lost = [t for i, t in enumerate(old) if i not in stayed_old]
    come = [t for j, t in enumerate(new) if j not in stayed_new]
    stood = body_points(lost, before.settled_views, np.eye(4))
    fate = verdicts(lost, stood, after.settled_views, T, seconds)
    stands = body_points(come, after.settled_views, T)
    past = verdicts(come, stands, before.settled_views, np.eye(4), seconds)
    told = [*zip(lost, fate, strict=True), *zip(come, past, strict=True)]
    difference.unchanged += [t.node for t, v in told if v is Verdict.THERE]
    difference.unknown = [t.node for t, v in zip(lost, fate, strict=True) if v is Verdict.UNKNOWN]
    gone = [t for t, v in zip(lost, fate, strict=True) if v is Verdict.GONE]
    # A place that nobody had looked at may well be where a thing went that has gone.
    newly = [t for t, v in zip(come, past, strict=True) if v is not Verdict.THERE]
    pairs = _moved(gone, newly)
    difference.moved = [(gone[i].node, newly[j].node) for i, j in pairs.items()]
    difference.vanished = [t.node for i, t in enumerate(gone) if i not in pairs]
    found = {newly[j] for j in pairs.values()}
    for thing, verdict in zip(come, past, strict=True):
        if verdict is not Verdict.THERE and thing not in found:
            known = verdict is Verdict.GONE
            (difference.appeared if known else difference.unknown).append(thing.node)
    return difference


def _stayed(
    old: Sequence[ComparedThing], new: Sequence[ComparedThing]
) -> tuple[set[int], set[int]]:
    """Indexes, in both maps, of what is where it was.

    Of things one to one; a surface that one visit saw in parts is all of them.
    """
    cost = np.full((len(old), len(new)), APART)
    for i, a in enumerate(old):
        for j, b in enumerate(new):
            if is_same_place(a, b):
                cost[i, j] = math.dist(a.xyz, b.xyz)
    pairs = list(_assigned(cost).items())
    pairs += [(i, j) for i, j in np.argwhere(cost < APART).tolist() if old[i].is_surface]
    return {i for i, _ in pairs}, {j for _, j in pairs}


def _moved(gone: Sequence[ComparedThing], newly: Sequence[ComparedThing]) -> dict[int, int]:
    """Index of what is gone to that of the same thing elsewhere: alike, rather near than far."""
    cost = np.full((len(gone), len(newly)), APART)
    for i, a in enumerate(gone):
        for j, b in enumerate(newly):
            if is_alike(a, b):
                cost[i, j] = 1 - same_belief(a, b) + math.dist(a.xyz, b.xyz) / (2 * FAR_M)
    return _assigned(cost)


def _assigned(cost: Array) -> dict[int, int]:
    """Least costly pairs, each of a row and a column (Hungarian method)."""
    rows, columns = linear_sum_assignment(cost)
    pairs = zip(rows.tolist(), columns.tolist(), strict=True)
    return {i: j for i, j in pairs if cost[i, j] < APART}
