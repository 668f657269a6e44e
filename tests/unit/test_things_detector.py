"""What the thing detector cuts out of scenes whose geometry is known exactly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from afkb.flow import Detection, View
from afkb_surfaces.detector import SurfaceDetector
from afkb_things.detector import ThingDetector
from depth_samples import FLOOR, Box, Cup, table, view_of

TABLE = table(1.0, 0.0, 0.73)
MUG = Cup((0.95, 0.1), 0.73, 0.10, 0.045)


def things(view: View, at_least: float = 0.5) -> list[Detection]:
    found = ThingDetector().detect(view, SurfaceDetector().detect(view))
    return [d for d in found if d.affords("DisposeAbility", at_least)]


def near(found: list[Detection], x: float, y: float, z: float) -> Detection:
    return min(found, key=lambda d: float(np.linalg.norm(d.position_xyz - np.array([x, y, z]))))


def hard(view: View, seed: int) -> View:
    """The same with noise three times as strong and every other pixel lost."""
    assert view.depth_m is not None
    rng = np.random.default_rng(seed)
    z = view.depth_m
    noisy = z + (z > 0) * rng.normal(size=z.shape) * 3 * (0.0012 + 0.0019 * (z - 0.4) ** 2)
    kept = rng.random(z.shape) < 0.5
    return replace(view, depth_m=np.where(kept, noisy, 0).astype(np.float32))


def test_two_boxes_that_touch_are_two() -> None:
    low = Box((0.85, -0.10, 0.73), (0.93, 0.02, 0.81))
    high = Box((0.93, -0.10, 0.73), (1.00, 0.02, 0.93))
    found = things(view_of([FLOOR, TABLE, low, high]))
    assert len(found) == 2
    assert near(found, 0.965, -0.04, 0.83).box.top == pytest.approx(0.93, abs=0.006)
    assert near(found, 0.89, -0.04, 0.77).box.top == pytest.approx(0.81, abs=0.006)


@pytest.mark.parametrize("noise", [None, 4])
def test_a_box_on_a_box_is_a_body_of_its_own(noise: int | None) -> None:
    lower = Box((0.85, -0.12, 0.73), (1.05, 0.12, 0.83))
    upper = Box((0.90, -0.05, 0.83), (1.00, 0.05, 0.93))
    rng = None if noise is None else np.random.default_rng(noise)
    found = things(view_of([FLOOR, TABLE, lower, upper], rng=rng))
    assert len(found) == 2
    shape = near(found, 0.95, 0.0, 0.88).footprint_xy
    assert np.ptp(shape, axis=0).max() < 0.13


def test_a_mug_beside_a_carton_is_apart_from_it() -> None:
    carton = Box((0.90, -0.04, 0.73), (0.98, 0.05, 0.93))
    found = things(view_of([FLOOR, TABLE, carton, MUG]))
    assert len(found) == 2
    assert near(found, 0.95, 0.1, 0.78).box.top == pytest.approx(0.83, abs=0.006)


@pytest.mark.parametrize("floor", [0.005, 0.02])
def test_the_inside_of_a_cup_belongs_to_it(floor: float) -> None:
    bowl = Cup((0.95, 0.0), 0.73, 0.08, 0.08, wall=floor)
    view = view_of([FLOOR, TABLE, bowl], pitch_deg=40, height=1.5)
    (found,) = things(view)
    assert found.pixels is not None and view.depth_m is not None
    empty = view_of([FLOOR, TABLE], pitch_deg=40, height=1.5).depth_m
    own = np.flatnonzero(np.abs(view.depth_m - empty) > 0.03)
    assert np.isin(own, found.pixels).mean() > 0.95


def test_what_stands_behind_a_pole_is_one() -> None:
    behind = Box((1.05, -0.15, 0.73), (1.13, 0.15, 0.85))
    pole = Box((0.85, -0.03, 0.73), (0.90, 0.03, 0.95))
    found = things(view_of([FLOOR, TABLE, behind, pole]))
    assert len(found) == 2
    assert np.ptp(near(found, 1.09, 0.0, 0.79).footprint_xy[:, 1]) > 0.26


def test_a_shade_is_of_its_lamp() -> None:
    stem = Box((0.94, -0.02, 0.73), (0.98, 0.02, 0.95))
    shade = Box((0.86, -0.10, 0.95), (1.06, 0.10, 1.06))
    assert len(things(view_of([FLOOR, TABLE, stem, shade]))) == 1


@pytest.mark.parametrize(
    ("thing", "kind", "size"),
    [
        (Box((0.90, -0.06, 0.73), (0.98, 0.06, 0.90)), "box", (0.12, 0.08, 0.17)),
        (Cup((0.95, 0.0), 0.73, 0.12, 0.04, wall=0.039), "cylinder", (0.08, 0.08, 0.12)),
    ],
    ids=["carton", "can"],
)
def test_the_shape_of_a_body_is_fitted(
    thing: Box | Cup, kind: str, size: tuple[float, float, float]
) -> None:
    (found,) = things(view_of([FLOOR, TABLE, thing], rng=np.random.default_rng(2)))
    assert found.primitive is not None
    assert found.primitive.kind == kind
    assert found.primitive.residual_m < 0.004
    assert found.box.size_xyz == pytest.approx(size, abs=0.012)


def test_bodies_stay_apart_through_noise_and_loss() -> None:
    carton = Box((0.85, -0.20, 0.73), (0.93, -0.10, 0.90))
    found = things(hard(view_of([FLOOR, TABLE, MUG, carton]), 5))
    assert len(found) == 2


@pytest.mark.parametrize(
    "scene",
    [
        [FLOOR, TABLE],
        [FLOOR],
        [FLOOR, Box((1.0, -9.0, 0.0), (1.2, 9.0, 9.0))],
        [FLOOR, TABLE, Box((1.38, -3.0, 0.0), (1.5, 3.0, 2.5))],
    ],
    ids=["bare table", "floor", "blank wall", "table at a wall"],
)
@pytest.mark.parametrize("seed", [None, 7])
def test_where_nothing_stands_nothing_is_found(scene: list[Box], seed: int | None) -> None:
    view = view_of(scene)
    assert things(view if seed is None else hard(view, seed)) == []


def test_a_bowl_seen_from_low_above_its_rim_is_one() -> None:
    bowl = Cup((1.5, 0.0), 0.73, 0.06, 0.09)
    (found,) = things(view_of([FLOOR, table(1.5, 0.0, 0.73), bowl], height=0.95, pitch_deg=12))
    assert found.box.size_xyz[:2] == pytest.approx((0.18, 0.18), abs=0.04)


def test_the_sides_of_a_shelf_and_the_legs_of_a_table_are_no_things() -> None:
    board = Box((1.0, -0.4, 0.68), (1.3, 0.4, 0.70))
    sides = [Box((1.0, y, 0.70), (1.3, y + 0.02, 1.0)) for y in (-0.4, 0.38)]
    legs = [Box((x, y, 0.0), (x + 0.04, y + 0.04, 0.68)) for x in (1.0, 1.26) for y in (-0.4, 0.36)]
    carton = Box((1.1, 0.0, 0.70), (1.16, 0.1, 0.85))
    found = things(view_of([FLOOR, board, *sides, *legs, carton]), at_least=0.1)
    (only,) = found
    assert only.position_xyz[:2] == pytest.approx([1.13, 0.05], abs=0.03)
