"""Compiled loops over points and pixels give what plain numpy and OpenCV give."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from afkb_mapping.from_above import box_around, hull_candidates, on_grid
from afkb_mapping.grid.components import components
from afkb_mapping.image_regions import Region, order_by_label, pixels_by_label
from afkb_mapping.order_statistics import percentile, percentiles

NUMBERS = st.floats(-50, 50, width=32)


@settings(max_examples=60, deadline=None)
@given(arrays(np.float64, st.integers(1, 60), elements=NUMBERS), st.floats(0, 100))
def test_a_percentile_is_numpys(values: np.ndarray, percent: float) -> None:
    expected = np.percentile(values, percent)
    assert percentile(values, percent) == pytest.approx(expected, abs=1e-12)
    low, high = percentiles(values, 2.0, percent)
    assert (low, high) == pytest.approx((np.percentile(values, 2.0), expected), abs=1e-12)


@settings(max_examples=40, deadline=None)
@given(arrays(np.float64, st.tuples(st.integers(1, 80), st.just(2)), elements=NUMBERS))
def test_no_corner_of_the_hull_is_left_out(xy: np.ndarray) -> None:
    def corners(points: np.ndarray) -> set[tuple[float, ...]]:
        hull = cv2.convexHull(points.astype(np.float32)).reshape(-1, 2)
        return {tuple(p) for p in hull.tolist()}

    assert corners(hull_candidates(xy)) == corners(xy)


def test_few_points_of_a_full_disc_may_be_corners() -> None:
    xy = np.random.default_rng(1).normal(size=(2000, 2))
    assert len(hull_candidates(xy)) < 200


@settings(max_examples=40, deadline=None)
@given(arrays(np.float64, st.tuples(st.integers(1, 40), st.just(2)), elements=NUMBERS))
def test_grid_squares_are_those_that_hold_points(xy: np.ndarray) -> None:
    expected = (np.unique(np.floor(xy / 0.5), axis=0) + 0.5) * 0.5
    assert on_grid(xy, 0.5).tolist() == expected.tolist()


def test_a_box_has_its_long_side_along_its_own_x() -> None:
    along = np.array([np.cos(0.5), np.sin(0.5)])
    across = np.array([-along[1], along[0]])
    xy = np.array([a * along + b * across for a in (-1, 1) for b in (-0.3, 0.3)])
    box = box_around(xy, 0.7, 0.0)
    assert box.yaw == pytest.approx(0.5, abs=1e-5)
    assert box.size_xyz == pytest.approx((2.0, 0.6, 0.02), abs=1e-5)
    assert box.top == pytest.approx(0.7)


def test_pixels_come_label_by_label_and_thinned() -> None:
    labels = np.random.default_rng(2).integers(-1, 5, (37, 53)).astype(np.int32)
    wanted, thin = np.array([False, True, False, True, True]), np.array([1, 1, 1, 3, 1])
    u, v, starts = pixels_by_label(labels, wanted, thin)
    for label in range(5):
        rows, cols = np.nonzero(labels == label)
        kept = wanted[label] & (rows % thin[label] == 0) & (cols % thin[label] == 0)
        part = slice(starts[label], starts[label + 1])
        assert v[part].tolist() == rows[kept].tolist()
        assert u[part].tolist() == cols[kept].tolist()


def test_a_region_knows_its_box_and_whether_the_image_cuts_it() -> None:
    u, v = np.array([5, 9, 7], np.int32), np.array([4, 4, 6], np.int32)
    region = Region(u, v, np.ones(3, np.float32), np.zeros((3, 3)), (20, 20))
    assert region.image_box == (5, 4, 10, 7)
    assert not region.cut_by_image
    assert Region(u, v, region.depth_m, region.points, (20, 11)).cut_by_image


@pytest.mark.parametrize("diagonal", [True, False])
@pytest.mark.parametrize("share", [0.2, 0.5, 0.7])
def test_groups_of_squares_are_opencvs(share: float, diagonal: bool) -> None:
    grid = (np.random.default_rng(6).random((41, 60)) < share).astype(np.uint8)
    count, labels, stats, _ = cv2.connectedComponentsWithStats(
        grid, connectivity=8 if diagonal else 4
    )
    found, measures = components(grid, diagonal)
    assert found.tolist() == labels.tolist()
    assert len(measures) == count
    assert measures[1:].tolist() == stats[1:].tolist()


def test_entries_come_label_by_label() -> None:
    labels = np.array([2, 0, 1, 2, 1, 0], np.int32)
    order, starts = order_by_label(labels, np.array([False, True, True]))
    assert order.tolist() == [2, 4, 0, 3]
    assert starts.tolist() == [0, 0, 2, 4]
