"""What the benchmark does to views is what it says."""

from __future__ import annotations

import numpy as np
import pytest

from afkb.flow import View
from afkb_mapping.geometry import back_project, transform
from bench.detectors.hardships import hardships
from depth_samples import FLOOR, Box, view_of

TABLE = Box((1.5, -0.6, 0.0), (2.3, 0.6, 0.75))


@pytest.fixture(scope="module")
def view() -> View:
    return view_of([FLOOR, TABLE])


@pytest.mark.parametrize("hardship", hardships(), ids=lambda h: h.label)
def test_what_is_left_stays_where_it_was(hardship, view: View) -> None:
    if hardship.axis in {"noise", "glass"}:
        return
    after = hardship.befall(view, np.random.default_rng(0))
    assert after.depth_m is not None and after.camera is not None
    points = back_project(after.depth_m, after.camera).reshape(-1, 3)
    points = points[np.isfinite(points).all(axis=1)].astype(np.float64)
    heights = transform(after.T_map_camera, points)[:, 2]
    on_top = np.abs(heights - 0.75) < 0.01
    assert on_top.sum() > 0.02 * after.depth_m.size * (
        1 - hardship.value * (hardship.axis == "missing")
    )
    assert ((heights > -0.01) & (heights < 0.76)).mean() > 0.999


def test_noise_is_a_multiple_of_the_sensors() -> None:
    flat = view_of([FLOOR], height=2.0, pitch_deg=90.0)
    assert flat.depth_m is not None
    for hardship in (h for h in hardships() if h.axis == "noise"):
        depth = hardship.befall(flat, np.random.default_rng(0)).depth_m
        assert depth is not None
        added = float(np.std(depth - flat.depth_m))
        sigma = 0.0012 + 0.0019 * 1.6**2
        assert added == pytest.approx(sigma * np.sqrt(hardship.value**2 - 1), rel=0.05)
