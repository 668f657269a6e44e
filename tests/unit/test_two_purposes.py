"""An open plan that serves two purposes says so; one purpose all over stays one."""

from __future__ import annotations

import numpy as np
import pytest

from afkb.flow import OccupancyGrid
from afkb_mapping.rooms.two_purposes import second_purpose
from afkb_mapping.segmentation.open_plan import Mask, Purpose

RESOLUTION_M = 0.1
PRIOR = {"Bedroom": 0.5, "Kitchen": 0.3, "Office": 0.2}
ODDS = 20.0
"""By which one thing speaks for its room."""


def grid_of(width_m: float, depth_m: float) -> tuple[OccupancyGrid, Mask]:
    shape = round(depth_m / RESOLUTION_M), round(width_m / RESOLUTION_M)
    grid = OccupancyGrid(np.zeros(shape, dtype=np.float32), RESOLUTION_M, (0.0, 0.0))
    return grid, np.ones(shape, dtype=bool)


def purpose_of(things: list[tuple[float, float, str]]) -> Purpose:
    """Each thing at x, y (m) speaks for one room category."""

    def purpose(part: Mask) -> dict[str, float] | None:
        belief = dict(PRIOR)
        told = False
        for x, y, room in things:
            if part[round(y / RESOLUTION_M), round(x / RESOLUTION_M)]:
                belief[room] *= ODDS
                told = True
        total = sum(belief.values())
        return {r: p / total for r, p in belief.items()} if told else None

    return purpose


def test_a_kitchen_with_a_desk_corner_serves_two_purposes() -> None:
    grid, room = grid_of(8, 4)
    things = [(1, 1, "Kitchen"), (1.5, 3, "Kitchen"), (2, 2, "Kitchen"), (0.5, 2, "Kitchen")]
    things += [(7, 1, "Office"), (6.5, 3, "Office"), (7, 2, "Office")]
    found = second_purpose(room, grid, purpose_of(things), PRIOR)
    assert found is not None
    assert found[0] == "Office"
    assert 0.76 < found[1] <= 1.0


def test_things_of_two_purposes_all_over_a_room_are_no_two_purposes() -> None:
    grid, room = grid_of(8, 4)
    spots = [(x, y) for x in (1, 3, 5, 7) for y in (1, 3)]
    things = [(x, y, ("Kitchen", "Office")[(i + i // 2) % 2]) for i, (x, y) in enumerate(spots)]
    assert second_purpose(room, grid, purpose_of(things), PRIOR) is None


@pytest.mark.parametrize(
    "things",
    [
        [],
        [(1, 1, "Kitchen"), (2, 3, "Kitchen"), (3, 2, "Kitchen")],
        [(1, 1, "Kitchen"), (7, 3, "Kitchen"), (4, 2, "Kitchen")],
    ],
    ids=["nothing", "one corner", "all over"],
)
def test_one_purpose_stays_one(things: list[tuple[float, float, str]]) -> None:
    grid, room = grid_of(8, 4)
    assert second_purpose(room, grid, purpose_of(things), PRIOR) is None


def test_a_room_too_small_for_two_parts_has_one_purpose() -> None:
    grid, room = grid_of(3, 2.5)
    things = [(0.5, 1, "Kitchen"), (2.5, 1, "Office")] * 5
    assert second_purpose(room, grid, purpose_of(things), PRIOR) is None


def test_the_surer_its_parts_the_surer_the_second_purpose() -> None:
    grid, room = grid_of(8, 4)
    some = [(1, 1, "Kitchen"), (7, 1, "Office"), (1, 3, "Kitchen"), (7, 3, "Office")]
    more = [*some, (0.5, 2, "Kitchen"), (7.5, 2, "Office"), (7.2, 2.5, "Office")]
    few, many = (second_purpose(room, grid, purpose_of(t), PRIOR) for t in (some, more))
    assert few is not None and many is not None
    assert few[1] < many[1]
