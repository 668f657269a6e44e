"""Where things of a category are: in which room, and on what; tables of the joint network."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.inference.bands import Array
from afkb.knowledge import SOMETHING_ELSE, AfNet

FLOOR, SUPPORT, NOWHERE = "Floor", "Support", "Nowhere"
"""What a thing is seen to stand on; `Nowhere`: nothing is below it where that was looked for."""
UNSTATED_SHARE = 0.25
"""What homes hold in rooms and on supports of which the ontology states no figure, beside the mean
of those of which it does: a figure is left out where next to nothing was counted."""


@dataclass(frozen=True, slots=True, eq=False)
class PlacementNetwork:
    """Tables of the joint network of a room's things; C categories, R rooms, K kinds of support.

    - `in_room`: (C, R), P(category of a thing | room category).
    - `kind`: (C,) index of the kind of support that a category is.
    - `on`: (K, C), how many times likelier a thing of a category stands on a support of that kind
      than a thing of whatever category does (paper §II.C: table → book, container → table).
    - `standing`: state to (C,), P(it is seen on the floor, on a support, on nothing | category).
    """

    rooms: tuple[str, ...]
    in_room: Array
    kind: NDArray[np.intp]
    on: Array
    standing: Mapping[str, Array]

    @classmethod
    def compile(cls, kb: AfNet, prior: Array) -> PlacementNetwork:
        """The tables that the ontology's figures state; `prior` (C,) of whatever room."""
        kind, on = _on_supports(kb, prior)
        return cls(tuple(kb.rooms), _in_rooms(kb, prior), kind, on, _standing(kb))

    def carries(self, messages: Array) -> Array:
        """What a thing says of what carries it: (C, ...) about the thing to (C, ...) about that."""
        carried: Array = np.tensordot(self.on, messages, axes=1)[self.kind]
        return carried

    def is_carried(self, messages: Array) -> Array:
        """What a carrier says of a thing on it: (C, ...) about the carrier to (C, ...)."""
        pooled = np.zeros((len(self.on), *messages.shape[1:]))
        np.add.at(pooled, self.kind, messages)
        said: Array = np.tensordot(self.on.T, pooled, axes=1)
        return said


def _in_rooms(kb: AfNet, prior: Array) -> Array:
    """A category's share of the things of a room: its prior, times how much likelier it is there.

    A category without figures has those of the nearest broader one, else is everywhere alike.
    """
    numbers: dict[str, dict[str, float]] = defaultdict(dict)
    for figure in kb.objects_in_rooms:
        numbers[figure.category][figure.room] = figure.mean_number
    rooms = list(kb.rooms)
    counted = {room for held in numbers.values() for room in held}
    weights = np.array([r.expected_number * (n in counted) for n, r in kb.rooms.items()])
    lift = np.ones((len(kb.categories), len(rooms)))
    for row, name in enumerate(kb.categories):
        held = _nearest(kb, name, numbers)
        if held is None or name == SOMETHING_ELSE:
            continue
        unstated = UNSTATED_SHARE * min(held.values())
        means = np.array([held.get(room, unstated) for room in rooms])
        mean = float(means @ weights / weights.sum())
        if mean > 0:
            lift[row] = np.where(weights > 0, means / mean, 1.0)
    shares = prior[:, None] * lift
    return np.asarray(shares / shares.sum(axis=0))


def _on_supports(kb: AfNet, prior: Array) -> tuple[NDArray[np.intp], Array]:
    """`kind` and `on`; kind 0 is of categories of which no figure tells, and says nothing."""
    put: dict[str, dict[str, float]] = defaultdict(dict)
    for figure in kb.objects_on_supports:
        put[figure.given][figure.category] = figure.probability
    supports = sorted({support for where in put.values() for support in where})
    column = {support: i for i, support in enumerate(supports)}
    where = [_nearest(kb, name, put) for name in kb.categories]
    stated = np.zeros((len(where), len(supports)))
    for row, shares in enumerate(where):
        for support, p in (shares or {}).items():
            stated[row, column[support]] = p
    told = np.array([w is not None for w in where]) & (prior > 0)
    kinds: list[tuple[str, ...]] = [()]
    index = [_kind(kb, name, supports, kinds) for name in kb.categories]
    on = np.ones((len(kinds), len(where)))
    if told.any():
        completed = _completed(stated[told], prior[told])
        common = prior[told] @ completed / prior[told].sum()
        for i, kind in enumerate(kinds[1:], start=1):
            of = [column[support] for support in kind]
            on[i, told] = completed[:, of].sum(axis=1) / common[of].sum()
    other = list(kb.categories).index(SOMETHING_ELSE)
    on[:, other] = 1.0
    return np.array(index, dtype=np.intp), on


def _completed(stated: Array, prior: Array) -> Array:
    """(N, S) stated shares, what is left of each row going to its other supports.

    In proportion to how common they are; some is always left, for homes hold what none counted.
    """
    common = prior @ stated / prior.sum()
    total = stated.sum(axis=1, keepdims=True)
    scaled = stated * np.minimum(1.0, (1.0 - UNSTATED_SHARE / 10) / np.maximum(total, 1e-12))
    left = 1.0 - scaled.sum(axis=1, keepdims=True)
    others = np.where(stated > 0, 0.0, common)
    weight = others.sum(axis=1, keepdims=True)
    even = np.divide(others, weight, out=np.zeros_like(others), where=weight > 0)
    return np.asarray(scaled + left * even)


def _kind(kb: AfNet, name: str, supports: list[str], kinds: list[tuple[str, ...]]) -> int:
    """The stated supports that are closest to a category: itself, else all of one broader kind."""
    for broader in kb.kinds_of(name):
        found = tuple(s for s in supports if broader in kb.kinds_of(s))
        if broader not in kb.categories and broader != name:
            break
        if found:
            kinds += [found] * (found not in kinds)
            return kinds.index(found)
    return 0


def _standing(kb: AfNet) -> Mapping[str, Array]:
    """A thing stands where such things do, and what carries it is seen, as the ontology states."""
    typical, seen = kb.parameters["StandsAsTypical"], kb.parameters["SupportSeen"]
    floor = {FLOOR: typical, SUPPORT: 1.0 - typical}
    on_floor = np.array([floor.get(c.stands_on, 0.5) for c in kb.categories.values()])
    nowhere = np.full(len(on_floor), 1.0 - seen)
    return {FLOOR: seen * on_floor, SUPPORT: seen * (1.0 - on_floor), NOWHERE: nowhere}


def _nearest(
    kb: AfNet, name: str, stated: Mapping[str, Mapping[str, float]]
) -> Mapping[str, float] | None:
    """What is stated of a category, else of the nearest broader one."""
    return next((stated[kind] for kind in kb.kinds_of(name) if stated.get(kind)), None)
