"""Where things may be adds up, falls where one has looked, and follows rooms and supports."""

from dataclasses import replace

import pytest

from afkb.errors import KnowledgeError
from afkb.finding import Node, Region, RoomNode, Surroundings, category_named, regions, somewhere
from afkb.finding.grasping import Grasp, grasps, is_graspable
from afkb.finding.holding import Holding, holding, numbers
from afkb.finding.untold import share_of
from afkb.knowledge import AfNet


@pytest.fixture(scope="module")
def kb() -> AfNet:
    return AfNet.load()


def node(id_: str, room: str = "room-1", **changes: object) -> Node:
    facts = {
        "kind": "ObservedEntity", "x": 1.0, "y": 2.0, "z": 0.7, "existence": 0.9,
        "belief": {"DiningTable": 1.0}, "room": room, "affords": {"SupportAbility": 0.95},
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
    assert at(regions("Table", home(cup, room_1="Kitchen"), kb), "thing-1", "thing") == 0.0
    assert [r.seen for r in found if r.node == "thing-1"] == [True]


def test_what_a_map_leaves_untold_goes_to_what_the_thing_looks_like(kb) -> None:
    facts = {"size": (0.09, 0.09, 0.1), "affords": {"ContainAbility": 0.95}, "z": 0.85}
    untold = node("thing-1", belief={"Jar": 0.5, "Can": 0.2}, **facts)
    around = home(untold, room_1="Kitchen")
    mug, bed = (at(regions(c, around, kb), "thing-1", "thing") for c in ("Mug", "Bed"))
    assert 0.2 * 0.9 >= mug > 10 * bed
    whole = sum(share_of(untold, [name], kb) for name in kb.categories)
    assert 0.7 < whole <= 1.0 + 1e-9


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
    table, bed = node("surface-1"), node("surface-2", belief={"Bed": 1.0})
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


def mug(id_: str = "thing-1", **changes: object) -> Node:
    facts = {
        "x": 0.0, "y": 0.0, "z": 0.85, "size": (0.09, 0.085, 0.1), "belief": {"Mug": 1.0},
        "affords": {"ContainAbility": 0.9}, "supported_by": "surface-1", "existence": 1.0,
    }  # fmt: skip
    return node(id_, **(facts | changes))


TABLE = node("surface-1", x=0.0, y=0.0, z=0.8)


def ways(kb: AfNet, *nodes: Node, walls: tuple = (), of: str = "thing-1") -> dict[str, Grasp]:
    around = replace(home(TABLE, *nodes, room_1="Kitchen"), walls=walls)
    found = regions("Mug", around, kb)
    return {
        w.grasp: w for w in grasps("Mug", found, around, kb) if w.node.id == of and w.part is None
    }


def test_a_mug_alone_on_a_table_is_taken_from_above_by_what_its_kind_affords(kb) -> None:
    way = ways(kb, mug())["LargeDiameterGrasp"]
    assert (way.approach, way.part, way.clear) == ("above", None, 1.0)
    assert way.width == pytest.approx(0.09) or way.width == pytest.approx(0.085)
    assert way.probability == pytest.approx(way.is_one * way.fits)
    afbit = next(a for a in kb.afbits if (a.category, a.feature) == ("Mug", "LargeDiameterGrasp"))
    assert way.fits == pytest.approx(afbit.strength)


def test_a_grasp_that_takes_another_size_does_not_fit(kb) -> None:
    assert "LargeDiameterGrasp" not in ways(kb, mug(size=(0.4, 0.4, 0.4)))
    assert "SmallDiameterGrasp" not in ways(kb, mug())


def test_fingers_close_where_neighbours_leave_room(kb) -> None:
    one_side = mug("thing-2", x=0.1, belief={"Jar": 1.0})
    way = ways(kb, mug(), one_side)["LargeDiameterGrasp"]
    assert way.clear == 1.0
    assert way.closing == pytest.approx(1.5708, abs=1e-3)
    assert way.width == pytest.approx(0.085)
    four = [
        mug(f"thing-{i}", x=dx, y=dy, belief={"Jar": 1.0}, z=0.9, size=(0.08, 0.08, 0.2))
        for i, (dx, dy) in enumerate(((0.09, 0.0), (-0.09, 0.0), (0.0, 0.09), (0.0, -0.09)), 2)
    ]
    way = ways(kb, mug(), *four)["LargeDiameterGrasp"]
    assert way.clear < 0.1
    assert "no clearance" in way.reason
    doubtful = [replace(n, existence=0.1) for n in four]
    assert ways(kb, mug(), *doubtful)["LargeDiameterGrasp"].clear > 0.6


def test_a_wide_cup_is_wrapped_round_its_body_and_not_from_top_to_bottom(kb) -> None:
    way = ways(kb, mug(size=(0.09, 0.09, 0.07), affords={"MediumWrapGrasp": 0.7}))
    assert (way["MediumWrapGrasp"].approach, way["MediumWrapGrasp"].clear) == ("above", 1.0)


def test_under_a_low_board_it_is_taken_from_the_side_that_is_open(kb) -> None:
    board = node("surface-2", x=0.0, y=0.0, z=0.95)
    back = (((-1.0, 0.06), (1.0, 0.06)),)
    shelf = replace(TABLE, size=(1.2, 0.1, 0.02))
    around = replace(home(shelf, board, mug(), room_1="Kitchen"), walls=back)
    way = next(w for w in grasps("Mug", regions("Mug", around, kb), around, kb) if w.part is None)
    assert (way.approach, way.clear) == ("side", 1.0)
    assert way.bearing == pytest.approx(1.5708, abs=1e-3)


def test_what_lies_flat_is_not_gripped_round_its_support(kb) -> None:
    book = mug(size=(0.25, 0.18, 0.04), belief={"Book": 1.0}, z=0.82)
    around = home(TABLE, book, room_1="Office")
    found = grasps("Book", regions("Book", around, kb), around, kb)
    flat = [w for w in found if w.grasp == "ExtensionTypeGrasp" and w.part is None]
    assert flat
    assert all(w.clear == 0.0 and "surface-1" in w.reason for w in flat)


def test_handles_are_grasped_that_no_map_measures(kb) -> None:
    around = home(TABLE, mug(), room_1="Kitchen")
    handle = [w for w in grasps("Mug", regions("Mug", around, kb), around, kb) if w.part]
    assert {w.part for w in handle} == {"HandlePart"}
    assert {w.width for w in handle} == {None}


def test_what_no_hand_takes_has_no_grasp(kb) -> None:
    assert is_graspable("Cup", kb)
    assert not is_graspable("Bathtub", kb)


class Changed(AfNet):
    """The bundled ontology with one figure's probability scaled; 0 deletes it."""

    def __init__(self, name: str, factor: float) -> None:
        super().__init__()
        self.name, self.factor = name, factor

    def _with(self, figures):
        kept = [f for f in figures if f.name != self.name]
        (figure,) = [f for f in figures if f.name == self.name] or [None]
        if figure is not None and self.factor > 0:
            kept.append(replace(figure, probability=figure.probability * self.factor))
        return tuple(kept)

    @property
    def objects_in_rooms(self):
        return self._with(super().objects_in_rooms)

    @property
    def objects_on_supports(self):
        return self._with(super().objects_on_supports)


@pytest.mark.parametrize("factor", [0.5, 0.0])
@pytest.mark.parametrize(
    ("figure", "at_node"), [("DiningTable.Mug.Support", "surface-1"), ("Mug.Kitchen.InRoom", None)]
)
def test_less_of_a_statement_moves_what_it_speaks_of_and_nothing_else(
    kb, figure, at_node, factor
) -> None:
    sofa = node("surface-2", "room-2", belief={"Couch": 1.0})
    around = home(node("surface-1"), sofa, room_1="Kitchen", room_2="LivingRoom")

    def told(category: str, base: AfNet) -> tuple[float, dict]:
        found = regions(category, around, base)
        there = [r for r in found if r.room == "room-1" and at_node in (None, r.node)]
        return somewhere(there), {(r.node, r.how): r.probability for r in found}

    changed = Changed(figure, factor)
    assert told("Mug", changed)[0] < 0.95 * told("Mug", kb)[0]
    # A saucepan, of which nothing is stated, is where containers are; a bowl may be in it.
    assert told("Bowl", changed)[1] == pytest.approx(told("Bowl", kb)[1], abs=1e-4)
