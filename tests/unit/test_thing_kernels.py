"""Compiled loops of the thing detector give what geometry says they must."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from afkb_things.distances import (
    BOX,
    CONE,
    CYLINDER,
    LYING,
    SPHERE,
    SUPERQUADRIC,
    distance,
    slopes,
)
from afkb_things.fitting import fit
from afkb_things.patches import contacts, patches_of
from afkb_things.roots import roots_of
from afkb_things.valleys import valleys

RNG = np.random.default_rng(3)
FOCAL = 260.0
Side = Callable[[np.ndarray, np.ndarray], float]


def two_planes(turn: float) -> np.ndarray:
    """Depth of two planes that meet in the middle column; a valley where turn is above 0."""
    across = (np.arange(80) - 39.5) / FOCAL
    return np.tile(0.8 / (1.0 + turn * np.abs(across)), (60, 1)).astype(np.float32)


@pytest.mark.parametrize("slant", [0.0, 2.0])
def test_a_plane_is_no_valley_however_it_slants(slant: float) -> None:
    depth = (0.8 / (1 + slant * (np.arange(80) - 40) / FOCAL)).astype(np.float32)
    flat = valleys(np.tile(depth, (60, 1)), FOCAL, 1.0)
    assert np.abs(flat[10:-10, 10:-10]).max() < 0.05


def test_a_concave_edge_is_a_valley_and_a_convex_one_isnt() -> None:
    assert valleys(two_planes(1.0), FOCAL, 1.0)[30, 39:41].min() > 1
    assert valleys(two_planes(-1.0), FOCAL, 1.0)[30, 39:41].max() < 0.5


def test_patches_part_at_a_valley_and_meet_there() -> None:
    depth = two_planes(1.0)
    valley = valleys(depth, FOCAL, 1.0)
    patches, count = patches_of(depth, np.ones((60, 80), np.int16), valley, 1.0)
    assert count == 2
    assert (patches > 0).all()
    meet = contacts(depth, patches, valley, 2, 1.0, 0)
    assert meet[1, 2, 0] == 60
    assert meet[1, 2, 1] / 60 > 1


SHAPES = [
    (CYLINDER, (0.1, 0.2, 0.04, 0.85), lambda p, q: np.hypot(*(q[:2] - p[:2])) - p[2]),
    (SPHERE, (0.1, 0.2, 0.8, 0.05), lambda p, q: np.linalg.norm(q - p[:3]) - p[3]),
    (LYING, (0.1, 0.2, 0.04, 0.3, 0.0), lambda p, q: np.hypot(q[1] - p[1], q[2] - 0.74) - p[2]),
]


@pytest.mark.parametrize(
    ("kind", "parameters", "side"), SHAPES, ids=["cylinder", "sphere", "lying"]
)
def test_distance_from_a_round_side_is_that_of_its_axis(kind, parameters, side) -> None:  # type: ignore[no-untyped-def]
    p = np.array(parameters)
    for turn in RNG.uniform(0, 6.28, 20):
        q = np.array([0.1, 0.2, 0.75]) + 0.06 * np.array([np.cos(turn), np.sin(turn), 0.1])
        if side(p, q) > 0:
            assert distance(kind, *q, p, 0.7) == pytest.approx(side(p, q), abs=1e-9)


def test_distance_from_a_box_is_the_way_to_its_nearest_point() -> None:
    p = np.array([0.1, 0.2, 0.05, 0.03, 0.4, 0.9])
    cos, sin = np.cos(0.4), np.sin(0.4)
    for q in RNG.uniform(-0.2, 0.2, (50, 3)) + np.array([0.1, 0.2, 0.8]):
        x, y = q[0] - 0.1, q[1] - 0.2
        local = np.array([x * cos + y * sin, y * cos - x * sin, q[2] - 0.8])
        nearest = np.clip(local, [-0.05, -0.03, -0.1], [0.05, 0.03, 0.1])
        if (nearest != local).any():
            apart = np.linalg.norm(local - nearest)
            assert distance(BOX, *q, p, 0.7) == pytest.approx(apart, abs=1e-9)


def test_a_superquadric_of_unit_exponents_is_an_ellipsoid() -> None:
    p = np.array([0.0, 0.0, 0.05, 0.05, 0.0, 0.1, 1.0, 1.0])
    for direction in RNG.normal(size=(20, 3)):
        q = 0.08 * direction / np.linalg.norm(direction) + np.array([0, 0, 0.05])
        assert distance(SUPERQUADRIC, *q, p, 0.0) == pytest.approx(0.03, abs=1e-6)


def test_a_cone_is_fitted_to_its_points() -> None:
    turn, z = RNG.uniform(0, 6.28, 200), RNG.uniform(0, 0.1, 200)
    radius = 0.03 + 0.4 * z
    points = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), z])
    start = np.array([0.01, -0.01, 0.04, 0.06, 0.11])
    found = fit(CONE, points, 0.0, start, 0.01, 20)
    assert found[:4] == pytest.approx([0, 0, 0.03, 0.07], abs=0.003)


def test_the_top_of_a_box_is_carried_by_its_table() -> None:
    raster = np.zeros((50, 50), np.uint64)
    raster[5:45, 5:45] = 0b100
    raster[20:25, 20:25] |= np.uint64(0b010)
    raster[0:4, 0:4] = 0b001
    heights, areas = np.array([1.5, 0.9, 0.74]), np.array([0.01, 0.01, 0.6])
    large = areas > 0.1
    assert roots_of(heights, areas, large, raster, 0.5).tolist() == [0, 2, 2]


PARAMETERS = {
    BOX: (0.1, 0.2, 0.05, 0.03, 0.4, 0.85),
    CYLINDER: (0.1, 0.2, 0.04, 0.85),
    LYING: (0.1, 0.2, 0.04, 0.1, 0.4),
    SPHERE: (0.1, 0.2, 0.77, 0.05),
    CONE: (0.1, 0.2, 0.03, 0.06, 0.85),
    SUPERQUADRIC: (0.1, 0.2, 0.05, 0.03, 0.4, 0.85, 0.4, 0.7),
}


@pytest.mark.parametrize("kind", PARAMETERS)
def test_slopes_are_what_a_small_step_changes(kind: int) -> None:
    p, step = np.array(PARAMETERS[kind]), 1e-6
    for x, y, z in RNG.uniform(-0.1, 0.1, (30, 3)) + np.array([0.1, 0.2, 0.775]):
        found = np.zeros(len(p))
        slopes(kind, x, y, z, p, 0.7, found)
        for i, one in enumerate(np.eye(len(p)) * step):
            ahead, back = (distance(kind, x, y, z, p + s, 0.7) for s in (one, -one))
            assert found[i] == pytest.approx((ahead - back) / (2 * step), abs=1e-4)
