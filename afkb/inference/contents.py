"""What a room holds: a noisy-OR of what it is for and of what is found together (paper §II.D.iii).

Room category and share seen are hidden; each object category is found or not. What makes it found:
the room, and every rarer category that is found and that, the ontology says, is met together with
it oftener than rooms explain (Pearl 1988, §4.3.2). How many there are follows from the room.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from afkb.errors import EvidenceError
from afkb.inference.bands import Array
from afkb.inference.causes import Cause, causes_of
from afkb.inference.holdings import Holdings, Stated, found_by_room
from afkb.inference.numbers import NUMBER_STARTS, number_table


@dataclass(frozen=True, eq=False)
class ContentsNetwork:
    """(C,) categories, (R,) rooms, (S,) shares seen; `prior` (R,), shares are equally probable.

    - `hazard`: (C, R), -ln P(none is found) by the room, the whole room seen, no cause at work.
    - `causes`: co-occurrences, each from a rarer category to a commoner one: no cycle.
    - `number`: (C, R) mean number where there is any, 1 or more.
    """

    categories: tuple[str, ...]
    rooms: tuple[str, ...]
    prior: Array
    shares: tuple[float, ...]
    hazard: Array
    causes: tuple[Cause, ...]
    number: Array

    @classmethod
    def compile(cls, stated: Stated) -> ContentsNetwork:
        """The network of what an ontology, or counts, state of rooms and of what is together."""
        return cls.of_holdings(Holdings.compile(stated), stated)

    @classmethod
    def of_holdings(cls, holdings: Holdings, stated: Stated) -> ContentsNetwork:
        """The same of tables of what rooms hold; only the co-occurrences are read from `stated`."""
        hazard = found_by_room(holdings.probability, stated.shares)
        return cls(
            holdings.categories,
            holdings.rooms,
            holdings.prior,
            stated.shares,
            hazard,
            causes_of(holdings, hazard, stated),
            holdings.number,
        )

    def among(self, categories: Collection[str]) -> ContentsNetwork:
        """The network of these categories alone, those that can be found: of others it is silent.

        Raises `EvidenceError` for a category that isn't here.
        """
        kept = sorted({self.at(name) for name in categories})
        new = {old: i for i, old in enumerate(kept)}
        return replace(
            self,
            categories=tuple(self.categories[i] for i in kept),
            hazard=self.hazard[kept],
            number=self.number[kept],
            causes=tuple(
                replace(c, source=new[c.source], effect=new[c.effect])
                for c in self.causes
                if c.source in new and c.effect in new
            ),
        )

    def likelihood(self, found: Mapping[str, int]) -> Array:
        """P(these are found, in these numbers, and no others | room, share), (R, S), scaled.

        `found`: category to how many, 0 as if it weren't named. Raises `EvidenceError` for a
        category that isn't here, or a bad number.
        """
        total = self._log_terms(self.seen(found)).sum(axis=0)
        return np.asarray(np.exp(total - total.max()))

    def beside(self, found: Mapping[str, int], weights: Array) -> dict[str, float]:
        """P(there is one, or one more | what is found), for every category.

        What isn't found is unobserved: for each category exact in the network of what is found and
        itself (`among`). `weights`: (R, S), P(room, share | everything else that is known), without
        `found`; need not sum to 1.
        """
        x = self.seen(found)
        held, present = np.flatnonzero(x), (x > 0).astype(np.float64)
        rooms, caused = self._room_beside(present), self.caused(present)[:, None, None]
        total = rooms + caused
        known = _log_found(total[held]) + self._log_number(x, held)[:, :, None]
        joint = _log(weights) + known.sum(axis=0)
        if_found, if_not = self._as_source(present, rooms, caused)
        asked = _share_of_first(joint + _log_found(total) + if_found, joint - total + if_not)
        one_more = (1.0 - 1.0 / self.number) @ _normal(joint).sum(axis=1)
        more = np.where(x > 0, one_more, asked)
        return dict(zip(self.categories, more.tolist(), strict=True))

    def each_hidden(self, found: Mapping[str, int], weights: Array) -> dict[str, float]:
        """P(any is found | all other categories as they are), each category as if not looked for.

        Of what is found it tells how much the rest of the room speaks for it (paper §II.C).
        """
        asked = self._each_asked(self.seen(found), weights)
        return dict(zip(self.categories, asked.tolist(), strict=True))

    def seen(self, found: Mapping[str, int]) -> Array:
        """(C,) numbers found; `EvidenceError` for a category that isn't here, or a bad number."""
        x = np.zeros(len(self.categories))
        for name, number in found.items():
            if not (math.isfinite(number) and number == int(number) and number >= 0):
                raise EvidenceError(f"{number} of {name}; expected a whole number, 0 or more")
            x[self.at(name)] = number
        return x

    def caused(self, present: Array) -> Array:
        """(C,) hazard from what is found together with it; `present` (C,) 0 or 1."""
        total = np.zeros(len(self.categories))
        np.add.at(total, self._effect, self.strength * present[self._source])
        return total

    @cached_property
    def _index(self) -> dict[str, int]:
        return {name: i for i, name in enumerate(self.categories)}

    def at(self, name: str) -> int:
        """The row of a category; `EvidenceError` where it has none."""
        if name not in self._index:
            raise EvidenceError(f"{name!r} is no object category of the network; mend its name")
        return self._index[name]

    @cached_property
    def _source(self) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
        return np.array([c.source for c in self.causes], dtype=np.intp)

    @cached_property
    def _effect(self) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
        return np.array([c.effect for c in self.causes], dtype=np.intp)

    @cached_property
    def strength(self) -> Array:
        """(causes,) hazard of each."""
        return np.array([c.hazard for c in self.causes], dtype=np.float64)

    @cached_property
    def _log_left(self) -> Array:
        return np.array([c.log_left for c in self.causes], dtype=np.float64)

    @cached_property
    def by_room(self) -> Array:
        """(C, R, S) hazards of the rooms, beside all causes."""
        return self._room_beside(np.ones(len(self.categories)))

    def _room_beside(self, sources: Array) -> Array:
        """(C, R, S) hazards of the rooms, beside the causes from these (C,) 0 or 1."""
        left = np.zeros(len(self.categories))
        np.add.at(left, self._effect, self._log_left * sources[self._source])
        rooms = (np.exp(left)[:, None] * self.hazard)[:, :, None]
        return np.asarray(rooms * np.array(self.shares))

    def _as_source(self, present: Array, rooms: Array, caused: Array) -> tuple[Array, Array]:
        """Log factors (C, R, S) of what is found, were each unobserved category found, and not.

        `rooms`, `caused`: hazards (C, R, S) by the room and by what is `present` (C,), of each.
        """
        if_found, if_not = np.zeros_like(rooms), np.zeros_like(rooms)
        tells = (present[self._effect] > 0) & (present[self._source] == 0)
        source, effect = self._source[tells], self._effect[tells]
        others, left = caused[effect], np.exp(self._log_left[tells])[:, None, None]
        without = left * rooms[effect] + others
        known = _log_found(rooms[effect] + others)
        by_it = self.strength[tells][:, None, None]
        np.add.at(if_found, source, _log_found(without + by_it) - known)
        np.add.at(if_not, source, _log_found(without) - known)
        return if_found, if_not

    def _log_terms(self, x: Array) -> Array:
        """(C, R, S) log-probability of each category's state, given its causes' states."""
        present = (x > 0).astype(np.float64)
        total = self.by_room + self.caused(present)[:, None, None]
        held = np.flatnonzero(x)
        logs = -total
        logs[held] = _log_found(total[held]) + self._log_number(x, held)[:, :, None]
        return np.asarray(logs)

    def _each_asked(self, x: Array, weights: Array) -> Array:
        """(C,) probability that each is found, given the others as they are."""
        logs, gain = self._log_terms(x), self._gain_if_found(x)
        held = np.flatnonzero(x)
        absent = np.broadcast_to(_log(weights) + logs.sum(axis=0), gain.shape).copy()
        absent[held] -= gain[held] + self._log_number(x, held)[:, :, None]
        return _share_of_first(absent + gain, absent)

    def _gain_if_found(self, x: Array) -> Array:
        """(C, R, S) log P(found, the others as they are) - log P(not found, …) of each category."""
        present = (x > 0).astype(np.float64)
        total = self.by_room + self.caused(present)[:, None, None]
        gain = _log_found(total) + total
        if self.causes:
            source, effect, strength = self._source, self._effect, self.strength[:, None, None]
            without = total[effect] - strength * present[source][:, None, None]
            change = np.where(
                present[effect][:, None, None] > 0,
                _log_found(without + strength) - _log_found(without),
                -strength,
            )
            np.add.at(gain, source, change)
        return np.asarray(gain)

    def _log_number(self, x: Array, held: np.ndarray[tuple[int], np.dtype[np.intp]]) -> Array:
        """(held, R) log-probability of how many are found, where any is."""
        bins = np.searchsorted(NUMBER_STARTS, x[held], side="right") - 1
        table = number_table(self.number[held])
        return np.asarray(np.log(table[bins, np.arange(len(held))]))


def _log_found(total: Array) -> Array:
    return np.asarray(np.log(-np.expm1(-np.maximum(total, 1e-9))))


def _share_of_first(first: Array, second: Array) -> Array:
    """(C,) probability of the first of two log joints over rooms and shares, (C, R, S)."""
    largest = np.maximum(first, second).max(axis=(1, 2), keepdims=True)
    one = np.exp(first - largest).sum(axis=(1, 2))
    return np.asarray(one / (one + np.exp(second - largest).sum(axis=(1, 2))))


def _log(weights: Array) -> Array:
    return np.log(np.maximum(weights, 1e-300))


def _normal(logs: Array) -> Array:
    shares = np.exp(logs - logs.max())
    return np.asarray(shares / shares.sum())
