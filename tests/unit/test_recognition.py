"""Things of a map are told by what carries them, and boards of one thing are put together."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from afkb.flow import Entity, NodeKind
from afkb.inference import Network
from afkb.inference.recognition import evidence_of, standing_together
from afkb.knowledge import AfNet
from afkb_mapping.things.recognition import recognised
from store_samples import entity


@pytest.fixture(scope="module")
def network() -> Network:
    return Network.compile(AfNet.load())


def board(name: str, height_m: float, x: float = 0.0, length_m: float = 1.2) -> Entity:
    corners = np.array([[x, 0], [x + length_m, 0], [x + length_m, 0.35], [x, 0.35]])
    return entity(
        name,
        position_xyz=(x + length_m / 2, 0.18, height_m),
        size_xyz=(length_m, 0.35, 0.02),
        affordances={"SupportAbility": 0.95},
        polygon_xy=corners,
        supported_by=None,
        room="room-1",
    )


def parts(network: Network, *things: Entity) -> dict[str, str | None]:
    return {e.id: e.part_of for e in recognised(things, lambda _: {}, network)}


def test_boards_over_each_other_are_parts_of_the_topmost(network: Network) -> None:
    things = board("low", 0.3), board("mid", 0.7), board("top", 1.1), board("aside", 0.7, 3.0)
    assert parts(network, *things) == {"low": "top", "mid": "top", "top": None, "aside": None}


def test_a_seat_under_a_table_is_no_board_of_it(network: Network) -> None:
    found = parts(network, board("seat", 0.45, length_m=0.4), board("table", 0.74))
    assert found == {"seat": None, "table": None}


def test_a_surface_seen_twice_is_not_two_boards(network: Network) -> None:
    assert parts(network, board("a", 0.7), board("b", 0.75)) == {"a": None, "b": None}


def test_boards_are_taken_for_a_shelf(network: Network) -> None:
    alone = recognised([board("a", 0.7)], lambda _: {}, network)[0]
    stacked = recognised([board("a", 0.7), board("b", 1.1)], lambda _: {}, network)[0]
    assert stacked.category_belief["Shelf"] > 3 * alone.category_belief["Shelf"]


def test_beliefs_sum_to_one_and_the_rest_stays(network: Network) -> None:
    floor = entity("floor", category_belief={"Floor": 1.0}, supported_by=None)
    predicted = entity("p", NodeKind.DUAL)
    told = recognised([floor, predicted, board("a", 0.7)], lambda _: {}, network)
    assert [e.id for e in told] == ["floor", "p", "a"]
    assert told[0].category_belief == floor.category_belief
    assert told[1].category_belief == predicted.category_belief
    assert sum(told[2].category_belief.values()) == pytest.approx(1.0)


def test_own_affordances_tell_of_the_room_but_not_of_the_thing(network: Network) -> None:
    table = dataclasses.replace(board("a", 0.74, length_m=1.6), room="room-1")
    own = evidence_of(table, network)
    assert own
    (alone,) = standing_together([table], lambda _: dict.fromkeys(own, 1), network)
    assert alone.room == pytest.approx(network.room_posterior(dict.fromkeys(own, 0)))


def doubtful_mug(supported_by: str | None) -> Entity:
    mug = board("mug", 0.83)
    affordances = {"ContainAbility": 0.9}
    at = {"size_xyz": (0.11, 0.1, 0.1), "supported_by": supported_by, "affordances": affordances}
    return dataclasses.replace(mug, existence=0.45, observations=3, polygon_xy=None, **at)


def test_a_doubtful_mug_on_a_table_is_there_and_one_on_nothing_is_not(network: Network) -> None:
    table = dataclasses.replace(board("table", 0.74), existence=0.97, observations=5)
    on_table, alone = (
        {e.id: e for e in recognised([table, doubtful_mug(on)], lambda _: {}, network)}
        for on in ("table", None)
    )
    assert on_table["mug"].existence > 0.5
    assert on_table["mug"].history[-1].after == on_table["mug"].existence
    assert on_table["table"].existence != alone["table"].existence
    assert "mug" not in alone


def test_what_followed_from_a_vanished_thing_alone_goes_with_it(network: Network) -> None:
    predicted = entity("p", NodeKind.DUAL, predicted_from=("mug",))
    told = recognised([doubtful_mug(None), predicted], lambda _: {}, network)
    assert told == []
