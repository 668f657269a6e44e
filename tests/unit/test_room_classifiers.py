"""Room classifiers stand beside the map's belief, and the one by doors and walls tells rooms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from afkb.flow import Doorway, Room, TopologicalMap
from afkb.knowledge import AfNet
from afkb.testing import sample_map
from afkb_mapping.rooms.opinions import with_opinions
from afkb_room_categories.classifier import CategoryClassifier
from afkb_room_shape.classifier import ShapeClassifier
from afkb_room_shape.shape import Shape, shape_of

L_SHAPE = np.array([(0, 0), (6, 0), (6, 3), (3, 3), (3, 6), (0, 6)], dtype=float)


@pytest.fixture(scope="module")
def knowledge_base() -> AfNet:
    return AfNet()


@pytest.fixture(scope="module")
def by_shape(knowledge_base: AfNet) -> ShapeClassifier:
    return ShapeClassifier(knowledge_base)


class Fails:
    """A classifier that breaks."""

    name = "fails"

    def beliefs(self, topological_map: TopologicalMap) -> Mapping[str, Mapping[str, float]]:
        raise RuntimeError("no idea")


def test_the_map_keeps_its_own_belief_and_gets_the_others_beside_it(
    by_shape: ShapeClassifier,
) -> None:
    before = sample_map()
    found = with_opinions(before, [by_shape])
    assert found.rooms[0].belief == before.rooms[0].belief
    told = by_shape.beliefs(before)["room-1"]
    assert found.rooms[0].other_beliefs == {"doors-and-walls": told}


def test_a_classifier_that_fails_is_named_and_loses_nobody_the_map(
    by_shape: ShapeClassifier,
) -> None:
    found = with_opinions(sample_map(), [Fails(), by_shape])
    assert set(found.rooms[0].other_beliefs) == {"doors-and-walls"}
    assert any("room classifier 'fails' failed with RuntimeError" in n for n in found.notes)


def test_a_shape_is_walls_doors_area_and_elongation() -> None:
    room = Room("room-1", 1, 1, 27.0, L_SHAPE, {"UnknownRoom": 1.0})
    doors = (
        Doorway("d1", 3, 0, 0, 0.9, ("room-1",)),
        Doorway("d2", 0, 3, 0, 0.9, ("room-1", "room-2"), existence=0.2),
    )
    found = replace(sample_map(), rooms=(room,), doorways=doors)
    assert shape_of(room, found) == Shape(27.0, 1, 6, pytest.approx(1.0))


def test_a_room_whose_outline_encloses_nothing_is_left_out(by_shape: ShapeClassifier) -> None:
    room = Room("room-1", 1, 1, 0.0, L_SHAPE[:2], {"UnknownRoom": 1.0})
    assert by_shape.beliefs(replace(sample_map(), rooms=(room,))) == {}


@pytest.mark.parametrize(
    ("shape", "room"),
    [
        (Shape(8.0, 5, 10, 4.0), "Hallway"),
        (Shape(70.0, 3, 8, 1.5), "LivingRoom"),
        (Shape(16.0, 2, 4, 1.2), "Bedroom"),
        (Shape(6.0, 1, 4, 1.5), "Bathroom"),
    ],
)
def test_plain_rooms_are_told_by_their_shape(
    by_shape: ShapeClassifier, shape: Shape, room: str
) -> None:
    belief = by_shape.posterior(shape)
    assert max(belief, key=lambda name: belief[name]) == room
    assert sum(belief.values()) == pytest.approx(1.0)


def test_more_doors_speak_for_a_hallway(by_shape: ShapeClassifier) -> None:
    few, many = (by_shape.posterior(Shape(9.0, n, 6, 2.0))["Hallway"] for n in (1, 6))
    assert many > 2 * few


def test_its_figures_are_read_from_the_table(knowledge_base: AfNet, tmp_path: Path) -> None:
    table = tmp_path / "figures.csv"
    table.write_text(
        "room,area_m2,doors,elongation,walls,source\nKitchen,9,1,1,4,x\nBedroom,40,1,1,4,x\n"
    )
    belief = ShapeClassifier(knowledge_base, table).posterior(Shape(9.0, 1, 4, 1.0))
    assert belief["Kitchen"] > belief["Bedroom"]


def with_things(categories: list[dict[str, float]]) -> TopologicalMap:
    """The sample's room, with things of these category beliefs in it and nothing counted."""
    plain = sample_map()
    thing = replace(plain.entities[0], room="room-1", existence=1.0)
    entities = [replace(thing, id=f"t{i}", category_belief=c) for i, c in enumerate(categories)]
    return replace(plain, entities=tuple(entities))


def test_recognised_things_tell_what_a_room_is_for(knowledge_base: AfNet) -> None:
    classifier = CategoryClassifier(knowledge_base)
    bare = classifier.beliefs(with_things([]))["room-1"]
    toilet = classifier.beliefs(with_things([{"Toilet": 0.9, "Chair": 0.1}]))["room-1"]
    assert toilet["Bathroom"] > 2 * bare["Bathroom"]


@pytest.mark.parametrize("belief", [{"Toilet": 0.4, "Chair": 0.3}, {"SomethingElse": 0.9}, {}])
def test_a_thing_that_could_be_several_is_none(
    knowledge_base: AfNet, belief: dict[str, float]
) -> None:
    classifier = CategoryClassifier(knowledge_base)
    bare = classifier.beliefs(with_things([]))["room-1"]
    assert classifier.beliefs(with_things([belief]))["room-1"] == pytest.approx(bare)


def test_a_recognised_thing_is_not_counted_by_its_class_as_well(knowledge_base: AfNet) -> None:
    found = with_things([{"Bed": 0.9}])
    bed = replace(found.entities[0], affordances={"SupportAbility": 0.95}, size_xyz=(2.0, 1.5, 0.1))
    bed = replace(bed, position_xyz=(1.0, 0.0, 0.5))
    counted = replace(found.rooms[0], evidence={"BedSupport": 1})
    classifier = CategoryClassifier(knowledge_base)
    both = classifier.beliefs(replace(found, entities=(bed,), rooms=(counted,)))
    once = classifier.beliefs(replace(found, entities=(bed,)))
    assert both["room-1"] == pytest.approx(once["room-1"])
