"""What speaks for a closed body and against: its outline, what is above it, and how it leans."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox, View
from afkb_containers.clearance import Above, above
from afkb_containers.edges import Edges, edges_of
from afkb_containers.face import face_of, narrowing_deg
from afkb_containers.sight import Sights
from afkb_mapping.bodies import Body, Stand, body_of
from afkb_mapping.depth_points import points_of_pixels
from depth_samples import FLOOR, Box, table, view_of

TABLE = table(1.3, 0.0, 0.73)
CARTON = Box((1.2, -0.05, 0.73), (1.27, 0.05, 0.93))
WALL = Box((1.34, -2.0, 0.0), (1.4, 2.0, 2.5))


def cut_out(view: View, wanted: Callable[[NDArray[np.float64]], NDArray[np.bool_]]) -> Detection:
    """A body of the points that are wanted, as a detector hands it on."""
    assert view.depth_m is not None
    v, u = np.nonzero(view.depth_m)
    _, points = points_of_pixels(u.astype(np.int32), v.astype(np.int32), view)
    pixels = (v * view.depth_m.shape[1] + u)[wanted(points)].astype(np.int32)
    return Detection(
        "test", {"DisposeAbility": 1.0}, OrientedBox((0, 0, 0), (1, 1, 1)), np.zeros(3),
        np.eye(3), np.zeros((1, 2)), len(pixels), 1.0,
        measures={"stand": float(Stand.ON_SUPPORT), "support_height": 0.73}, pixels=pixels,
    )  # fmt: skip


def in_carton(points: NDArray[np.float64]) -> NDArray[np.bool_]:
    low, high = np.array([1.18, -0.055, 0.74]), np.array([1.28, 0.055, 0.94])
    return np.all((points > low) & (points < high), axis=-1)


def seen(things: list[Box], every: int = 1) -> tuple[Body, Above, Edges]:
    view = view_of([FLOOR, TABLE, *things], pitch_deg=20.0)
    body = body_of(cut_out(view, in_carton), view, every)
    sight = Sights(view).every(every)
    top = float(np.percentile(body.points[:, 2], 98))
    return body, above(body, top, sight), edges_of(body, sight.depth_m, 1)


@pytest.mark.parametrize("every", [1, 2])
def test_a_carton_that_stands_alone_ends_all_around_and_is_free_above(every: int) -> None:
    body, over, edges = seen([CARTON], every)
    assert over.free > 0.95
    assert edges.free > 0.95
    assert edges.hidden == 0.0
    assert len(edges.inner) > 0.7 * len(body.u)


def test_what_carries_a_shade_is_not_free_above() -> None:
    shade = Box((1.08, -0.15, 0.955), (1.38, 0.15, 1.1))
    _, over, _ = seen([CARTON, shade])
    assert over.filled > 0.8


def test_half_of_an_outline_may_be_hidden() -> None:
    before = Box((1.0, -0.3, 0.73), (1.05, 0.0, 0.93))
    _, _, edges = seen([CARTON, before])
    assert 0.2 < edges.hidden < 0.6


@pytest.mark.parametrize(("depth_m", "free"), [(0.04, 1.0), (0.0, 0.0)])
def test_a_part_of_a_wall_goes_on_and_what_stands_just_before_it_does_not(
    depth_m: float, free: float
) -> None:
    thing = Box((1.34 - depth_m, -0.05, 0.73), (1.345 - depth_m / 2, 0.05, 0.93))
    view = view_of([FLOOR, TABLE, WALL, thing], pitch_deg=10.0)

    def wanted(p: NDArray[np.float64]) -> NDArray[np.bool_]:
        near = p[..., 0] < 1.345 - depth_m / 3
        return near & (abs(p[..., 1]) < 0.051) & (p[..., 2] > 0.74) & (p[..., 2] < 0.94)

    assert view.depth_m is not None
    noise = np.random.default_rng(2).normal(0, 0.01, view.depth_m.shape)
    noisy = view.depth_m + noise.astype(np.float32)
    body = body_of(cut_out(view, wanted), replace(view, depth_m=noisy))
    assert edges_of(body, noisy, 1).free == pytest.approx(free, abs=0.2)


def test_a_body_thinned_to_every_third_row_and_column_is_that_of_the_thinned_image() -> None:
    view = view_of([FLOOR, TABLE, CARTON])
    thing = cut_out(view, in_carton)
    body, whole = body_of(thing, view, 3), body_of(thing, view)
    thinned = Sights(view).every(3).depth_m
    assert body.shape == thinned.shape
    assert len(body.u) == pytest.approx(len(whole.u) / 9, rel=0.1)
    assert np.array_equal(thinned[body.v, body.u], body.depth_m)


def test_a_bottle_grows_narrower_and_a_leaning_plate_does_not() -> None:
    rng = np.random.default_rng(5)
    y, z = rng.uniform(-1, 1, 4000), rng.uniform(0, 0.2, 4000)
    front = np.array([1.0, 0.0, 0.0])
    plate = np.column_stack([1.0 + 0.17 * z, 0.1 * y, z])
    assert narrowing_deg(plate, front) == 0.0
    radius = 0.05 - 0.15 * z
    bottle = np.column_stack([1.0 - radius * np.sqrt(1 - y * y), radius * y, z])
    assert narrowing_deg(bottle, front) == pytest.approx(np.degrees(np.arctan(0.15)), abs=1.5)
    strays = np.column_stack([rng.uniform(0.9, 1.3, 600), rng.uniform(-0.1, 0.1, 600), z[:600]])
    share, normal = face_of(np.vstack([plate, strays]), front, 0.002)
    assert 0.8 < share < 0.92
    assert np.degrees(np.arcsin(abs(normal[2]))) == pytest.approx(9.65, abs=1.0)
