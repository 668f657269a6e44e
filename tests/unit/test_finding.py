"""Where things may be adds up, falls where one has looked, and follows rooms and supports."""

from dataclasses import replace

import pytest

from afkb.errors import KnowledgeError
from afkb.finding import Node, Region, RoomNode, Surroundings, category_named, regions, somewhere
from afkb.finding.holding import Holding, holding, numbers
from afkb.knowledge import AfNet


@pytest.fixture(scope="module")
def kb() -> AfNet:
    return AfNet.load()


def node(id_: str, room: str = "room-1", **changes: object) -> Node:
    facts = {
        "kind": "ObservedEntity", "x": 1.0, "y": 2.0, "z": 0.7, "existence": 0.9,
        "belief": {"DiningTable": 0.8}, "room": room, "affords": {"SupportAbility": 0.95},
        "size": (1.2, 0.8, 0.02), "viewpoints": 3,
    }  # fmt: skip
    return Node(id_, **(facts | changes))


def home(*nodes: Node, **rooms: str) -> Surroundings:
    known = {
        name.replace("_", "-"): RoomNode(name.replace("_", "-"), 0.0, 0.0, {purpose: 1.0}, 2)
        for name, purpose in rooms.items()
    }
    return Surroundings({n.id: n for n in nodes}, known)


def at(found: list[Region], node: str, how: str) -> float:
    return sum(r.probability for r in found if r.node == node and r.how == how)


@pytest.mark.parametrize(
    ("text", "name"),
    [("mug", "Mug"), ("MUGS", "Mug"), ("remote-control", "RemoteControl"), ("couches", "Couch"),
     ("cell phone", "MobilePhone"), ("trash can", "TrashCan"), ("container", "Container")],
)  # fmt: skip
def test_a_category_goes_by_its_name_its_label_and_what_others_call_it(kb, text, name) -> None:
    assert category_named(text, kb) == name


def test_what_nothing_is_called_is_refused_with_names_that_are_near(kb) -> None:
    with pytest.raises(KnowledgeError, match=r"'muggle' is no object category.*did you mean.*Mug"):
        category_named("muggle", kb)
    with pytest.raises(KnowledgeError, match="see `afkb ontology show`"):
        category_named("qqqq", kb)


def test_what_was_seen_may_be_one_by_its_existence_and_its_kinds(kb) -> None:
    cup = node("thing-1", affords={}, belief={"Mug": 0.3, "PaperCup": 0.2, "Jar": 0.5})
    found = regions("Cup", home(cup, room_1="Kitchen"), kb)
    assert at(found, "thing-1", "thing") == pytest.approx(0.9 * 0.5)
    assert [r.seen for r in found if r.node == "thing-1"] == [True]


def test_probabilities_add_up_over_the_regions_of_a_room(kb) -> None:
    around = home(node("surface-1"), node("surface-2", viewpoints=0), room_1="Kitchen")
    around = replace(around, rooms={"room-1": replace(around.rooms["room-1"], viewpoints=0)})
    unlooked = {i: replace(n, viewpoints=0) for i, n in around.nodes.items()}
    found = regions("Mug", replace(around, nodes=unlooked), kb)
    assert somewhere(found) == pytest.approx(holding("Mug", kb)["Kitchen"].probability)
    assert somewhere(regions("Mug", around, kb)) < somewhere(found)


def test_where_one_has_looked_often_it_is_less_likely(kb) -> None:
    looked = [
        at(regions("Mug", home(node("surface-1", viewpoints=n), room_1="Kitchen"), kb),
           "surface-1", "support")
        for n in range(4)
    ]  # fmt: skip
    assert looked == sorted(looked, reverse=True)
    assert looked[3] < looked[0] / 3


def test_it_is_where_such_things_are_put_and_in_rooms_that_hold_them(kb) -> None:
    table, bed = node("surface-1"), node("surface-2", belief={"Bed": 0.9})
    found = regions("Mug", home(table, bed, room_1="LivingRoom"), kb)
    assert at(found, "surface-1", "support") > 3 * at(found, "surface-2", "support") > 0
    there = home(
        node("surface-1"), node("surface-2", "room-2"), room_1="Kitchen", room_2="Bathroom"
    )
    found = regions("Mug", there, kb)
    assert at(found, "surface-1", "support") > at(found, "surface-2", "support")


def test_what_stands_on_the_floor_is_on_no_support(kb) -> None:
    found = regions("Fridge", home(node("surface-1"), room_1="Kitchen"), kb)
    assert [r.how for r in found] == ["room"]


def test_one_that_was_found_leaves_less_to_find_of_what_a_room_has_one_of(kb) -> None:
    fridge = node("thing-1", affords={}, belief={"Fridge": 1.0}, existence=1.0)
    without = at(regions("Fridge", home(room_1="Kitchen"), kb), "room-1", "room")
    beside = at(regions("Fridge", home(fridge, room_1="Kitchen"), kb), "room-1", "room")
    assert beside < without / 3


def test_a_map_without_rooms_has_regions_too(kb) -> None:
    found = regions("Mug", Surroundings({"surface-1": node("surface-1", "nowhere")}), kb)
    assert [r.node for r in found] == ["surface-1"]
    assert regions("Mug", Surroundings(), kb) == []


def test_a_home_holds_as_many_as_the_ontology_expects_of_what_stands_alone(kb) -> None:
    for name in ("Fridge", "Bed", "Desk"):
        mean = sum(kb.rooms[room].expected_number * n for room, n in numbers(name, kb).items())
        assert mean == pytest.approx(kb.categories[name].expected_number, rel=0.25)


def test_a_look_that_overlooks_nothing_leaves_nothing() -> None:
    held = Holding(0.8, 1.5)
    assert held.overlooked(0.0) == held.another(0.0) == 0.0
    assert held.overlooked(1.0) == pytest.approx(0.8)
    assert 0.0 < held.overlooked(0.1) < 0.1 / 0.3
