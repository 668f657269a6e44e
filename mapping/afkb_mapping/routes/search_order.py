"""In which order to look in places for a thing: least expected way until it is found.

Each place i holds such a thing with probability p_i, independent of the others; who has looked in
some of them in vain goes on with probability Q, the product of their 1 - p_i. The expected way of
an order is the sum over its legs of the leg's length times Q of the places before it (Stone,
Theory of Optimal Search, 1975, ch. 5; with travel it is a travelling salesman's problem whose later
legs weigh less).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

EXACT_UP_TO = 13
"""Places up to which all orders are weighed, 13 · 8192 states; above, a local search does."""


@dataclass(frozen=True, slots=True)
class SearchOrder:
    """An order of places, its expected way, m, and a way that no order can undercut, m."""

    order: tuple[int, ...]
    expected_m: float
    at_least_m: float

    @property
    def exact(self) -> bool:
        """Whether no other order is better."""
        return self.at_least_m == self.expected_m


def best_order(probabilities: Sequence[float] | Array, ways_m: Array) -> SearchOrder:
    """The order with the least expected way; exact up to `EXACT_UP_TO` places.

    `ways_m` (n + 1, n + 1): lengths of the ways between the start, row 0, and the places.
    """
    p = np.asarray(probabilities, dtype=np.float64)
    if not len(p):
        return SearchOrder((), 0.0, 0.0)
    if len(p) <= EXACT_UP_TO:
        order = _by_all_subsets(p, ways_m)
        cost = expected_way(order, p, ways_m)
        return SearchOrder(order, cost, cost)
    orders = [_improved(order, p, ways_m) for order in naive_orders(p, ways_m)]
    best = min(orders, key=lambda order: expected_way(order, p, ways_m))
    return SearchOrder(best, expected_way(best, p, ways_m), lower_bound(p, ways_m))


def expected_way(order: Sequence[int], p: Array, ways_m: Array) -> float:
    """Expected way, m, until the thing is found, or until all places were looked in."""
    at, going_on, total = 0, 1.0, 0.0
    for place in order:
        total += going_on * float(ways_m[at, place + 1])
        going_on *= 1.0 - float(p[place])
        at = place + 1
    return total


def way_if_known(p: Array, ways_m: Array) -> float:
    """Expected way, m, of one who knows which places hold it and goes to the nearest, if any."""
    going_on, total = 1.0, 0.0
    for place in np.argsort(ways_m[0, 1:], kind="stable"):
        total += going_on * float(p[place] * ways_m[0, place + 1])
        going_on *= 1.0 - float(p[place])
    return total


def naive_orders(p: Array, ways_m: Array) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """The nearest next, from wherever one is; and the most probable first."""
    left, at, nearest = set(range(len(p))), 0, []
    while left:
        place = min(left, key=lambda i: (ways_m[at, i + 1], i))
        left.remove(place)
        nearest.append(place)
        at = place + 1
    probable = sorted(range(len(p)), key=lambda i: (-p[i], i))
    return tuple(nearest), tuple(probable)


def lower_bound(p: Array, ways_m: Array) -> float:
    """A way, m, that no order undercuts: each place found as soon as the straight way there allows.

    Where all is in vain, at least the farthest place was gone to.
    """
    in_vain = float(np.prod(1.0 - p))
    return way_if_known(p, ways_m) + in_vain * float(ways_m[0, 1:].max())


def _by_all_subsets(p: Array, ways_m: Array) -> tuple[int, ...]:
    """Dynamic programming over the sets of places looked in and the last of them (Held and Karp).

    The chance of going on depends on the set alone and not on its order, so that the best way to
    have looked in a set is part of the best way on.
    """
    n = len(p)
    sets = np.arange(1 << n)
    members = (sets[:, None] >> np.arange(n)) & 1 == 1
    going_on = np.where(members, 1.0 - p, 1.0).prod(axis=1)
    cost = np.full((1 << n, n), np.inf)
    before = np.full((1 << n, n), -1)
    for i in range(n):
        cost[1 << i, i] = ways_m[0, i + 1]
    between = ways_m[1:, 1:]
    for some in range(1, (1 << n) - 1):
        ways = cost[some][:, None] + going_on[some] * between
        last, out = ways.argmin(axis=0), np.flatnonzero(~members[some])
        cost[some | 1 << out, out] = ways[last[out], out]
        before[some | 1 << out, out] = last[out]
    some, order = (1 << n) - 1, [int(cost[-1].argmin())]
    while (last := int(before[some, order[-1]])) >= 0:
        some ^= 1 << order[-1]
        order.append(last)
    return tuple(order[::-1])


def _improved(order: Sequence[int], p: Array, ways_m: Array) -> tuple[int, ...]:
    """Turn parts round and move single places as long as that shortens the expected way."""
    best, cost = list(order), expected_way(order, p, ways_m)
    n, better = len(best), True
    while better:
        better = False
        for i in range(n):
            for j in range(n):
                other = _turned(best, i, j) if i < j else _moved(best, i, j)
                value = expected_way(other, p, ways_m)
                if value < cost - 1e-9:
                    best, cost, better = other, value, True
    return tuple(best)


def _turned(order: list[int], i: int, j: int) -> list[int]:
    return [*order[:i], *order[i : j + 1][::-1], *order[j + 1 :]]


def _moved(order: list[int], i: int, j: int) -> list[int]:
    rest = order[:i] + order[i + 1 :]
    return [*rest[:j], order[i], *rest[j:]]
