"""What has changed between two visits, as things and looks at their places tell it."""

from dataclasses import replace

import numpy as np
import pytest

from afkb.errors import MapError
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.localisation.localiser import Located
from afkb_mapping.memory.memory import Memory
from afkb_mapping.memory.remembered import RememberedView
from afkb_mapping.memory.visit import Visit
from afkb_mapping.visits.alignment import T_first_second, is_continued_by
from afkb_mapping.visits.body_points import look_at_body
from afkb_mapping.visits.diff import compared
from afkb_mapping.visits.things import ComparedThing
from mapping_samples import view

MUG = {"Mug": 0.7, "Bowl": 0.2, "Can": 0.1}
CHAIR = {"Chair": 0.9, "Stool": 0.1}
EYE = np.eye(4)


def thing(id_, x, y, z=1.1, size=(0.1, 0.1, 0.1), category=None, affords=("ContainAbility",)):
    length, width, _ = size
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / 2
    return ComparedThing(
        node={"id": id_, "x": x, "y": y, "z": z, "yaw": 0.0, "room": None},
        xyz=(x, y, z),
        size_xyz=size,
        polygon_xy=np.array([x, y]) + corners * [length, width],
        affords=frozenset(affords),
        category=category or MUG,
        existence=0.97,
        weight=0.3,
        extent_known=True,
        last_seen=0.0,
    )


def seat(id_, x, y, **more):
    wanted = {"z": 0.45, "size": (0.45, 0.45, 0.02), "category": CHAIR}
    return thing(id_, x, y, affords=("SupportAbility",), **(wanted | more))


def visit(depth_m, *poses, T=EYE):
    """A memory of views that look straight ahead at a wall so far away."""
    memory = Memory()
    memory.begin(Visit("recording", {}, EYE, frames=len(poses)))
    for i, (x, y, yaw) in enumerate(poses):
        seen = view(i, x, y, yaw, depth_m)
        seen = replace(seen, T_map_base=T @ seen.T_map_base)
        memory.keep(RememberedView(seen, (), ()).thinned())
    return memory


AHEAD = [(0.0, 0.3 * k, 0.0) for k in (-2, -1, 0, 1, 2)]
"""Poses from which what is 2 m ahead is in view."""


def told(old, new, before_m=4.0, after_m=4.0, T=EYE):
    before, after = visit(before_m, *AHEAD), visit(after_m, *AHEAD, T=np.linalg.inv(T))
    found = compared(old, new, before, after, T, 86400.0)
    names = {
        kind: [node["id"] for node in getattr(found, kind)]
        for kind in ("vanished", "appeared", "unchanged", "unknown")
    }
    pairs = [(a["id"], b["id"]) for a, b in found.moved]
    return {k: v for k, v in {**names, "moved": pairs}.items() if v}


def test_what_is_where_it_was_is_unchanged():
    old, new = [thing("a", 2.0, 0.0), seat("s", 2.0, 0.6)], [thing("b", 2.05, 0.0)]
    assert told(old, [*new, seat("t", 2.1, 0.6)]) == {"unchanged": ["b", "t"]}


def test_what_is_seen_through_has_vanished_and_what_is_hidden_or_aside_is_unknown():
    old = [thing("a", 2.0, 0.0)]
    assert told(old, []) == {"vanished": ["a"]}
    assert told(old, [], after_m=1.0) == {"unknown": ["a"]}
    assert told([thing("a", -2.0, 0.0)], []) == {"unknown": ["a"]}


def test_what_stands_where_nothing_stood_has_appeared():
    new = [thing("b", 2.0, 0.0)]
    assert told([], new) == {"appeared": ["b"]}
    assert told([], new, before_m=1.0) == {"unknown": ["b"]}


def test_the_same_elsewhere_has_moved_to_the_nearest_that_is_alike():
    old = [thing("a", 2.0, 0.3), thing("big", 2.0, -0.5, size=(0.4, 0.4, 0.4))]
    new = [thing("far", 2.0, -0.8), thing("near", 2.0, 0.0)]
    assert told(old, new) == {"moved": [("a", "near")], "vanished": ["big"], "appeared": ["far"]}


def test_what_has_gone_may_be_where_nobody_had_looked_before():
    assert told([thing("a", 2.0, 0.0)], [thing("b", -2.0, 0.0)]) == {"moved": [("a", "b")]}
    assert told([thing("a", -2.0, 0.0)], [thing("b", 2.0, 0.0)]) == {
        "appeared": ["b"],
        "unknown": ["a"],
    }


def test_another_kind_of_thing_is_not_the_same_one_moved():
    chair = thing("b", 2.0, 0.4, category=CHAIR)
    assert told([thing("a", 2.0, 0.0)], [chair]) == {"vanished": ["a"], "appeared": ["b"]}


def test_a_surface_that_depth_still_meets_is_unchanged_though_no_detector_spoke_of_it():
    low = seat("s", 2.0, 0.0, z=1.2, size=(0.2, 0.45, 0.02))
    assert told([low], [], after_m=2.0) == {"unchanged": ["s"]}


@pytest.mark.parametrize(
    ("after_m", "said"), [(2.0, "unchanged"), (4.0, "vanished"), (1.0, "unknown")]
)
def test_a_thing_is_there_where_depth_still_meets_its_shape(after_m, said):
    old = thing("a", 2.0, 0.0, size=(0.1, 0.3, 0.3))
    assert told([old], [], before_m=2.0, after_m=after_m) == {said: ["a"]}


def test_what_stands_right_on_a_top_is_asked_only_of_rays_that_would_pass_over_that_top():
    seen, points = view(0, depth_m=2.0), np.array([[2.0, 0.0, 1.0]])
    assert look_at_body(seen, points, bottom_m=0.9).hit == 1.0
    assert look_at_body(view(0, depth_m=4.0), points, bottom_m=0.9).empty == 1.0
    assert look_at_body(seen, points, bottom_m=0.98).in_view == 0.0


def test_another_thing_beside_the_place_or_of_another_height_is_not_the_same():
    for other in (thing("b", 2.1, 0.0), thing("b", 2.0, 0.0, z=1.15)):
        assert "unchanged" not in told([thing("a", 2.0, 0.0)], [other])


def test_a_surface_that_a_visit_saw_in_parts_is_all_of_them():
    halves = [seat("s", 2.0, 0.0), seat("t", 2.0, 0.46)]
    whole = seat("u", 2.0, 0.23, size=(0.45, 0.9, 0.02))
    assert told(halves, [whole]) == {"unchanged": ["u"]}
    assert told([whole], halves) == {"unchanged": ["s", "t"]}


def test_views_of_a_map_in_another_frame_are_looked_at_in_the_first_ones():
    T = T_from_xy_yaw(3.0, -1.0, 1.2)
    assert told([thing("a", 2.0, 0.0)], [], T=T) == {"vanished": ["a"]}


class Guide:
    """A localiser that knows where a second map's frame lies, but for some wrong answers."""

    def __init__(self, T, wrong):
        self._T, self._asked, self._wrong = T, 0, wrong

    def locate(self, views):
        self._asked += 1
        if self._asked in self._wrong:
            return Located(False, 40.0 * self._asked, 0.0, 1.0, 0.95, EYE[:3, :3])
        x, y = self._T[:2, :2] @ np.array([0.0, 0.6]) + self._T[:2, 3]
        return Located(self._T is EYE, x, y, 1.2, 0.95, EYE[:3, :3])


def aligned(monkeypatch, tmp_path, T, wrong=()):
    monkeypatch.setattr(
        "afkb_mapping.visits.alignment.localiser_of", lambda folder: Guide(T, wrong)
    )
    return T_first_second(tmp_path / "one", tmp_path / "two", visit(2.0, *[(0, 0.6, 0.0)] * 9))


def test_a_second_map_is_located_in_the_first_by_answers_that_agree(monkeypatch, tmp_path):
    T = T_from_xy_yaw(3.0, -1.0, 1.2)
    np.testing.assert_allclose(aligned(monkeypatch, tmp_path, T, {1, 3}), T, atol=1e-9)


@pytest.mark.parametrize("wrong", [(), range(20)])
def test_a_map_of_another_place_is_told_by_one_clear_error(monkeypatch, tmp_path, wrong):
    with pytest.raises(MapError, match=r"two can't be located in .*one: another place"):
        aligned(monkeypatch, tmp_path, EYE, wrong)


def test_an_update_is_known_by_the_visits_that_it_begins_with():
    first, other = visit(2.0, (0, 0, 0)), visit(2.0, (0, 0, 0), (1, 0, 0))
    updated = first.continued()
    updated.begin(other.visits[0])
    assert is_continued_by(first, updated)
    assert not is_continued_by(updated, first)
    assert not is_continued_by(first, first)
    assert not is_continued_by(other, updated)
