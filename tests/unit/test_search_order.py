"""The order of places to look in: no other is better, and what is said to bound it does."""

import itertools

import numpy as np
import pytest

from afkb_mapping.routes.search_order import (
    EXACT_UP_TO,
    best_order,
    expected_way,
    lower_bound,
    naive_orders,
    way_if_known,
)


def places(n: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    xy = rng.uniform(0, 10, (n + 1, 2))
    return rng.uniform(0.02, 0.9, n), np.linalg.norm(xy[:, None] - xy, axis=2)


@pytest.mark.parametrize(("n", "seed"), [(1, 0), (3, 1), (5, 2), (6, 3), (6, 4)])
def test_no_order_of_all_is_better_than_the_exact_one(n, seed) -> None:
    p, ways = places(n, seed)
    found = best_order(p, ways)
    least = min(expected_way(o, p, ways) for o in itertools.permutations(range(n)))
    assert found.exact and sorted(found.order) == list(range(n))
    assert found.expected_m == pytest.approx(least)
    assert lower_bound(p, ways) <= least + 1e-9


def test_the_expected_way_is_what_trials_take_on_average() -> None:
    p, ways = places(4, 5)
    order, rng = (2, 0, 3, 1), np.random.default_rng(6)
    walked = []
    for _ in range(20_000):
        at, length = 0, 0.0
        for place in order:
            length += ways[at, place + 1]
            at = place + 1
            if rng.random() < p[place]:
                break
        walked.append(length)
    assert np.mean(walked) == pytest.approx(expected_way(order, p, ways), rel=0.02)


def test_of_many_places_the_order_is_no_worse_than_naive_ones_and_above_its_bound() -> None:
    p, ways = places(EXACT_UP_TO + 4, 7)
    found = best_order(p, ways)
    naive = [expected_way(o, p, ways) for o in naive_orders(p, ways)]
    assert not found.exact
    assert found.at_least_m <= found.expected_m <= min(naive)
    assert sorted(found.order) == list(range(len(p)))


def test_a_sure_place_near_by_comes_before_an_unlikely_one_on_the_way_back() -> None:
    p = np.array([0.99, 0.05])
    ways = np.array([[0, 1.0, 1.0], [1.0, 0, 2.0], [1.0, 2.0, 0]])
    assert best_order(p, ways).order == (0, 1)
    assert way_if_known(p, ways) == pytest.approx(0.99 + 0.01 * 0.05)


def test_nothing_to_look_at_takes_no_way() -> None:
    assert best_order([], np.zeros((1, 1))).expected_m == 0.0
