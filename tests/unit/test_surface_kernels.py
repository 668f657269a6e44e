"""Compiled loops of the surface detector give what plain numpy gives."""

from __future__ import annotations

import numpy as np
import pytest

from afkb_surfaces.extents import filled_footprint, mode_height, tilt_and_rms
from afkb_surfaces.upright import fitted_segment

RNG = np.random.default_rng(4)


def test_tilt_and_rms_are_those_of_the_plane_of_least_squares() -> None:
    xy = RNG.uniform(-1, 1, (300, 2))
    z = 0.1 * xy[:, 0] - 0.05 * xy[:, 1] + RNG.normal(0, 0.01, 300)
    design = np.column_stack([xy, np.ones(300)])
    slope, *_ = np.linalg.lstsq(design, z, rcond=None)
    tilt_deg, rms = tilt_and_rms(np.column_stack([xy, z]))
    assert tilt_deg == pytest.approx(np.degrees(np.arctan(np.hypot(*slope[:2]))), abs=1e-3)
    assert rms == pytest.approx(np.sqrt(np.mean((z - design @ slope) ** 2)), rel=1e-4)


def test_the_height_of_a_surface_is_where_most_of_it_lies() -> None:
    z = np.concatenate([RNG.normal(0.73, 0.001, 500), RNG.uniform(0.6, 0.9, 200)])
    points = np.column_stack([RNG.uniform(-1, 1, (700, 2)), z])
    assert mode_height(points) == pytest.approx(0.73, abs=0.001)


def test_a_footprint_is_filled_where_the_image_shows_the_surface() -> None:
    intrinsics = np.array([100.0, 100.0, 49.5, 49.5])
    T = np.array([[1.0, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 2.0], [0, 0, 0, 1]])
    labels = np.zeros((100, 100), np.int32)
    labels[40:60, 30:70] = 3
    corners = np.array([[-0.2, -0.1, 1.0], [0.2, 0.1, 1.0]])
    filled = filled_footprint(corners, labels, 3, 1.0, intrinsics, T, 0.02)
    assert len(filled) * 0.02**2 == pytest.approx(0.4 * 0.2, rel=0.12)
    alone = filled_footprint(corners, labels, 9, 1.0, intrinsics, T, 0.02)
    assert len(alone) == 2


def test_a_segment_runs_along_the_widest_spread_of_its_points() -> None:
    t, off = RNG.uniform(-1, 1, 400), RNG.normal(0, 0.01, 400)
    along = np.array([np.cos(0.7), np.sin(0.7)])
    xy = t[:, None] * along + off[:, None] * np.array([-along[1], along[0]])
    centred = xy - xy.mean(axis=0)
    across = np.linalg.svd(centred)[2][1]
    segment, rms = fitted_segment(xy, 0.0)
    ends = np.percentile(centred @ np.linalg.svd(centred)[2][0], [0.5, 99.5])
    assert np.hypot(*(segment[1] - segment[0])) == pytest.approx(ends[1] - ends[0], rel=1e-9)
    assert rms == pytest.approx(np.sqrt(np.mean((centred @ across) ** 2)), rel=1e-9)
