"""What the container detector says about scenes whose geometry is known exactly."""

from __future__ import annotations

import numpy as np
import pytest

from afkb.flow import Detection, View
from afkb_containers.detector import ContainerDetector
from afkb_surfaces.detector import SurfaceDetector
from afkb_things.detector import ThingDetector
from depth_samples import FLOOR, Box, Cup, table, view_of

TABLE = table(1.3, 0.0, 0.73)
MUG = Cup((1.2, 0.1), 0.73, 0.10, 0.045)


def containers(view: View, at_least: float = 0.5) -> list[Detection]:
    surfaces = SurfaceDetector().detect(view)
    things = ThingDetector().detect(view, surfaces)
    found = ContainerDetector().detect(view, [*surfaces, *things])
    return [d for d in found if d.affords("ContainAbility", at_least)]


@pytest.mark.parametrize("seed", [None, 11])
def test_a_mug_on_a_table_is_one_open_container(seed: int | None) -> None:
    rng = None if seed is None else np.random.default_rng(seed)
    (mug,) = containers(view_of([FLOOR, TABLE, MUG], rng=rng))
    assert not mug.affords("IntrinsicContainAbility")
    assert mug.position_xyz == pytest.approx([1.2, 0.1, 0.78], abs=0.02)
    assert mug.box.bottom == pytest.approx(0.73, abs=0.005)
    assert mug.box.top == pytest.approx(0.83, abs=0.006)
    assert mug.measures["support_height"] == pytest.approx(0.73, abs=0.005)


def test_a_carton_is_contained_intrinsically_and_so_contains() -> None:
    carton = Box((1.15, -0.05, 0.73), (1.23, 0.05, 0.90))
    (found,) = containers(view_of([FLOOR, TABLE, carton]))
    assert found.affords("IntrinsicContainAbility")
    assert found.box.size_xyz[2] == pytest.approx(0.17, abs=0.01)


@pytest.mark.parametrize(
    "thing",
    [
        Box((1.1, -0.1, 0.73), (1.3, 0.1, 0.75)),
        Box((1.2, -0.1, 0.73), (1.212, 0.1, 0.93)),
        Box((1.15, -0.08, 0.73), (1.25, 0.08, 0.785)),
    ],
    ids=["magazine", "frame", "controller"],
)
def test_what_is_thin_or_low_is_no_container(thing: Box) -> None:
    assert containers(view_of([FLOOR, TABLE, thing])) == []


def test_a_magazine_under_a_mug_does_not_join_it() -> None:
    magazine = Box((1.05, -0.1, 0.73), (1.35, 0.25, 0.75))
    mug = Cup((1.2, 0.1), 0.75, 0.10, 0.045)
    (found,) = containers(view_of([FLOOR, TABLE, magazine, mug]))
    assert max(found.box.size_xyz[:2]) < 0.12


def test_two_mugs_side_by_side_are_two() -> None:
    other = Cup((1.2, -0.05), 0.73, 0.10, 0.045)
    assert len(containers(view_of([FLOOR, TABLE, MUG, other]))) == 2


def test_a_cup_above_an_occluder_is_seen_without_its_support() -> None:
    screen = Box((0.9, -1.0, 0.0), (0.92, 1.0, 1.02))
    cup = Cup((1.2, 0.0), 0.92, 0.12, 0.05)
    found = containers(view_of([FLOOR, screen, cup, table(1.2, 0.0, 0.92)], pitch_deg=15))
    (hidden,) = [d for d in found if abs(d.box.top - 1.04) < 0.01]
    assert "support_height" not in hidden.measures


def test_a_bin_on_the_floor_is_open() -> None:
    (found,) = containers(view_of([FLOOR, Cup((1.3, 0.2), 0.0, 0.45, 0.14)]))
    assert found.box.bottom == pytest.approx(0.0, abs=0.01)
    assert found.box.top == pytest.approx(0.45, abs=0.01)


def test_a_basin_let_into_a_counter_contains() -> None:
    top, bottom = 0.9, 0.72
    counter = [
        Box((0.9, -0.9, 0.0), (1.05, 0.9, top)),
        Box((1.35, -0.9, 0.0), (1.5, 0.9, top)),
        Box((1.05, -0.9, 0.0), (1.35, -0.2, top)),
        Box((1.05, 0.2, 0.0), (1.35, 0.9, top)),
        Box((1.05, -0.2, 0.0), (1.35, 0.2, bottom)),
    ]
    found = containers(view_of([FLOOR, *counter], height=1.5, pitch_deg=35))
    assert any(
        d.measures["depth"] == pytest.approx(top - bottom, abs=0.03)
        and d.position_xyz[:2] == pytest.approx([1.2, 0.0], abs=0.05)
        for d in found
    )


def test_a_table_and_a_wall_alone_hold_nothing() -> None:
    wall = Box((1.72, -3.0, 0.0), (1.8, 3.0, 2.5))
    assert containers(view_of([FLOOR, TABLE, wall]), at_least=0.1) == []
