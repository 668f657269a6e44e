"""Compiled loops of the surface detector give what plain numpy gives."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from afkb_surfaces.borders import KINDS, count_borders
from afkb_surfaces.cells import N_ROWS, X
from afkb_surfaces.extents import footprint_of
from afkb_surfaces.labelled import Labelled, members_of, runs_by_label
from afkb_surfaces.outline import ring_area, rings_of
from afkb_surfaces.patches import HEIGHT, RMS, TILT, measure_patches
from afkb_surfaces.upright import fitted_segment

RNG = np.random.default_rng(4)
Points = NDArray[np.float64]
INTRINSICS = np.array([100.0, 100.0, 49.5, 49.5])
DOWN = np.array([[1.0, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 2.0], [0, 0, 0, 1]])
"""A camera 2 m up that looks straight down."""


def patch_of(points: Points) -> Points:
    """Measures of a patch whose cells lie at points (N, 3), a metre away."""
    n = len(points)
    planes = np.ones((1, N_ROWS, n), np.float32)
    planes[0, X : X + 3] = points.T
    order, starts, wanted = np.arange(n), np.array([0, n]), np.ones(1, np.bool_)
    measures: Points = measure_patches(order, starts, wanted, planes, 3, 0.007, 1.5)[0]
    return measures


def test_tilt_and_rms_are_those_of_the_plane_of_least_squares() -> None:
    xy = RNG.uniform(-1, 1, (300, 2))
    z = 0.1 * xy[:, 0] - 0.05 * xy[:, 1] + RNG.normal(0, 0.01, 300)
    design = np.column_stack([xy, np.ones(300)])
    slope, *_ = np.linalg.lstsq(design, z, rcond=None)
    measures = patch_of(np.column_stack([xy, z]))
    assert measures[TILT] == pytest.approx(np.arctan(np.hypot(*slope[:2])), abs=1e-5)
    assert measures[RMS] == pytest.approx(np.sqrt(np.mean((z - design @ slope) ** 2)), rel=1e-3)


def test_the_height_of_a_surface_is_where_most_of_it_lies() -> None:
    z = np.concatenate([RNG.normal(0.73, 0.001, 500), RNG.uniform(0.6, 0.9, 200)])
    points = np.column_stack([RNG.uniform(-1, 1, (700, 2)), z])
    assert patch_of(points)[HEIGHT] == pytest.approx(0.73, abs=0.001)


def test_a_footprint_is_filled_where_the_image_shows_the_surface() -> None:
    labels = np.zeros((100, 100), np.int32)
    labels[40:60, 30:70] = 3
    span, level = (-0.3, 0.3, -0.2, 0.2), np.array([0.0, 0.0, 1.0])
    depth, cells = np.ones((100, 100), np.float32), np.zeros((25, 25), np.int32)
    shown = (level, INTRINSICS, DOWN, 0.02, depth, cells)
    filled = footprint_of(labels, 3, span, *shown)
    assert len(filled) * 0.02**2 == pytest.approx(0.4 * 0.2, rel=0.12)
    assert len(footprint_of(labels, 9, span, *shown)) == 0


def test_lost_pixels_of_a_cell_are_of_its_surface_and_no_gaps_in_a_footprint() -> None:
    cells = np.zeros((25, 25), np.int32)
    cells[10:15, 8:17] = 3
    lost = RNG.random((100, 100)) < 0.5
    depth = np.where(lost, 0, 1).astype(np.float32)
    labels = np.where(lost, 0, cells.repeat(4, axis=0).repeat(4, axis=1))
    span, level = (-0.3, 0.3, -0.2, 0.2), np.array([0.0, 0.0, 1.0])
    filled = footprint_of(labels, 3, span, level, INTRINSICS, DOWN, 0.02, depth, cells)
    assert len(filled) * 0.02**2 == pytest.approx(0.36 * 0.2, rel=0.12)


def test_an_outline_keeps_what_is_seen_through_and_bridges_what_stands_on_it() -> None:
    labels = np.zeros((100, 100), np.int32)
    labels[20:80, 20:80] = 3
    labels[30:45, 30:45] = labels[60:70, 60:70] = 0
    depth = np.where(labels > 0, 1.0, 1.8).astype(np.float32)
    depth[60:70, 60:70] = 0.8
    wanted = np.array([False, False, False, True])
    image = Labelled(labels, depth, INTRINSICS, (0, 0, 100, 100), labels > 0, labels > 0, 1, 1)
    runs, starts = runs_by_label(labels, np.ones((25, 25), np.bool_), 4, wanted)
    assert starts.tolist() == [0, 0, 0, 0, len(runs)]
    members, box = members_of(runs, 100)
    assert box == (20, 20, 80, 80)
    assert members.tolist() == np.flatnonzero(labels).tolist()
    outer, hole = rings_of(image, runs, box, np.array([0.0, 0.0, 1.0]), DOWN)
    assert ring_area(outer) == pytest.approx(0.59**2, rel=0.01)
    assert 0.15**2 <= ring_area(hole) <= 0.16**2
    assert np.abs(hole.mean(axis=0) - [-0.12, 0.12]).max() < 0.02


def test_a_border_is_told_by_what_lies_beyond_it() -> None:
    labels = np.zeros((60, 60), np.int32)
    labels[20:40, 10:60] = 1
    depth = np.full((60, 60), 1.5, np.float32)
    depth[labels > 0] = 1.0
    depth[40:], depth[:, :10] = 0.0, 0.6
    counts = count_borders(
        depth, labels, labels > 0, 1, (0, 0, 60, 60), np.array([False, True]), 6, 1.0
    )
    assert dict(zip(KINDS, counts[1], strict=True)) == {
        "real": 50,
        "occluded": 20,
        "cut": 20,
        "missing": 50,
    }


def test_a_segment_runs_along_the_widest_spread_of_its_points() -> None:
    t, off = RNG.uniform(-1, 1, 400), RNG.normal(0, 0.01, 400)
    along = np.array([np.cos(0.7), np.sin(0.7)])
    xy = t[:, None] * along + off[:, None] * np.array([-along[1], along[0]])
    centred = xy - xy.mean(axis=0)
    across = np.linalg.svd(centred)[2][1]
    x0, y0, x1, y1, rms = fitted_segment(xy, 0.0)
    ends = np.percentile(centred @ np.linalg.svd(centred)[2][0], [0.5, 99.5])
    assert np.hypot(x1 - x0, y1 - y0) == pytest.approx(ends[1] - ends[0], rel=1e-9)
    assert rms == pytest.approx(np.sqrt(np.mean((centred @ across) ** 2)), rel=1e-9)
