"""What is near is found, whatever was put, moved and taken out before; and in order of arrival."""

import numpy as np

from afkb_mapping.bounds import BoundMerger
from afkb_mapping.box_index import BoxIndex
from afkb_mapping.ids import Ids
from afkb_mapping.things.association import Association
from mapping_samples import container, view


def test_a_question_finds_every_box_that_touches_the_first_to_come_first() -> None:
    rng = np.random.default_rng(0)
    index: BoxIndex[int] = BoxIndex()
    boxes: dict[int, tuple[np.ndarray, np.ndarray]] = {}
    for step in range(400):
        thing = int(rng.integers(60))
        if thing in boxes and rng.random() < 0.3:
            index.remove(thing)
            del boxes[thing]
        else:
            low = rng.uniform(-20, 20, 2)
            boxes[thing] = low, low + rng.uniform(0, 4, 2)
            index.put(thing, *boxes[thing])
        low = rng.uniform(-20, 20, 2)
        high = low + rng.choice([0.5, 40.0]) * rng.random(2)
        found = index.near(low, high)
        touching = [t for t, (a, b) in boxes.items() if (a <= high).all() and (low <= b).all()]
        assert set(touching) <= set(found) <= set(boxes), step
        assert [t for t in boxes if t in found] == found
    assert list(index) == list(boxes)


def test_a_question_costs_by_what_is_near_and_not_by_what_there_is() -> None:
    index: BoxIndex[int] = BoxIndex()
    for n in range(1000):
        index.put(n, np.array([10.0 * n, 0.0]), np.array([10.0 * n + 0.5, 0.5]))
    assert index.near(np.array([500.0, 0.0]), np.array([500.2, 0.2])) == [50]


def test_things_far_from_a_view_take_no_part_in_its_association(monkeypatch) -> None:
    association = Association(Ids())
    for n in range(30):
        association.match(view(n), [container(20.0 * n, 0.0)])
    asked = []
    near = association._things_near
    monkeypatch.setattr(
        association, "_things_near", lambda found: asked.append(len(near(found))) or near(found)
    )
    (track,) = association.match(view(31), [container(100.0, 0.0)])
    assert track is not None and track.id == "thing-6" and asked == [1]


def test_walls_that_are_new_or_grow_are_told_once_with_where_they_are() -> None:
    bounds = BoundMerger()
    bounds.add_segment(np.array([[0.0, 0.0], [2.0, 0.0]]), "laser")
    bounds.add_segment(np.array([[50.0, 0.0], [50.0, 3.0]]), "laser")
    bounds.add_segment(np.array([[2.1, 0.0], [4.0, 0.0]]), "laser")
    boxes = bounds.changed()
    assert len(boxes) == 3 and len(bounds.bounds()) == 2
    np.testing.assert_allclose(boxes[-1], [[0.0, 0.0], [4.0, 0.0]], atol=1e-9)
    assert bounds.changed() == []
    assert bounds.part(np.array([1.0, -1.0]), np.array([1.0, 1.0]))
    assert not bounds.part(np.array([1.0, 1.0]), np.array([1.0, 2.0]))
