"""An open plan that serves two purposes says so; one purpose all over stays one."""

from __future__ import annotations

import numpy as np
import pytest

from afkb.flow import Entity, NodeKind, OccupancyGrid
from afkb.inference import network_of
from afkb.knowledge import AfNet
from afkb_mapping.rooms.evidence import RoomEvidence
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


Seen = tuple[str, tuple[float, float, float], tuple[float, float, float]]
"""What a thing affords, its position and its size, m."""
BED: list[Seen] = [
    ("SupportAbility", (1.2, 2.0, 0.50), (2.0, 1.6, 0.05)),
    ("SupportAbility", (0.4, 0.6, 0.55), (0.45, 0.4, 0.02)),
    ("SupportAbility", (0.4, 3.4, 0.60), (0.45, 0.4, 0.02)),
]
COUNTERS: list[Seen] = [
    ("SupportAbility", (7.6, 1.0, 0.9), (1.8, 0.6, 0.02)),
    ("SupportAbility", (7.6, 3.0, 0.9), (1.8, 0.6, 0.02)),
    ("SupportAbility", (6.0, 2.0, 0.74), (1.2, 0.8, 0.02)),
    *(("SupportAbility", (5.5 + 0.4 * k, 1.4, 0.45), (0.4, 0.4, 0.02)) for k in range(3)),
    *(("ContainAbility", (7.5, 0.5 + 0.3 * k, 1.0), (0.09, 0.09, 0.1)) for k in range(8)),
]


def evidence_of(things: list[Seen], room: Mask, grid: OccupancyGrid) -> RoomEvidence:
    """Of things that were seen by the bundled network."""
    entities = [
        Entity(
            id=f"t{i}",
            kind=NodeKind.OBSERVED,
            position_xyz=position,
            size_xyz=size,
            yaw=0.0,
            affordances={affords: 0.95},
            existence=1.0,
            category_belief={},
            movability="Static",
            matching_weight=1.0,
            observations=3,
            first_seen=0.0,
            last_seen=1.0,
            seen_from=(),
            generated_by=("test",),
        )
        for i, (affords, position, size) in enumerate(things)
    ]
    looked_from = [np.array([2.0, 2.0]), np.array([6.0, 2.0])]
    return RoomEvidence(network_of(AfNet()), entities, looked_from, room.astype(np.int32), grid)


@pytest.mark.parametrize(
    ("things", "purposes"),
    [
        (BED + COUNTERS, {"Bedroom", "Kitchen"}),
        (BED, {"Bedroom"}),
        (COUNTERS, {"Kitchen"}),
    ],
    ids=["a flat of one room", "a bedroom", "a kitchen"],
)
def test_affordances_tell_both_purposes(things: list[Seen], purposes: set[str]) -> None:
    grid, room = grid_of(8, 4)
    evidence = evidence_of(things, room, grid)
    whole = evidence.posterior(room)
    prior = network_of(AfNet()).room_posterior({})
    second = second_purpose(room, grid, evidence.purpose, prior)
    found = {max(whole, key=lambda r: whole[r]), *([second[0]] if second else [])}
    assert found == purposes
