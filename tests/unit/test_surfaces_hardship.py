"""The surface detector under hardship: it finds the table still, and invents none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from afkb.flow import Detection, PinholeCamera, View
from afkb_surfaces.detector import SurfaceDetector
from afkb_surfaces.settings import SurfaceSettings
from depth_samples import CAMERA, FLOOR, Box, table, view_of

SMALL = PinholeCamera(320, 240, 262.5, 262.5, 159.5, 119.5)
WIDE = PinholeCamera(1280, 720, 920.0, 920.0, 639.5, 359.5)
SCENE = (FLOOR, table(1.6, 0.1, 0.73), Box((3.0, -5.0, 0.0), (3.2, 5.0, 2.6)))


def supports(view: View) -> list[Detection]:
    found = SurfaceDetector().detect(view)
    return [d for d in found if d.affords("SupportAbility") and not d.measures.get("is_floor")]


def without(share: float, view: View) -> View:
    assert view.depth_m is not None
    lost = np.random.default_rng(8).random(view.depth_m.shape) < share
    return replace(view, depth_m=np.where(lost, np.float32(0), view.depth_m))


HARDSHIPS = {
    "noise": lambda rng: view_of(SCENE, rng=rng, noise=3.0),
    "half": lambda rng: without(0.5, view_of(SCENE, rng=rng)),
    "three quarters": lambda rng: without(0.75, view_of(SCENE, rng=rng)),
    "320x240": lambda rng: view_of(SCENE, rng=rng, camera=SMALL),
    "1280x720": lambda rng: view_of(SCENE, rng=rng, camera=WIDE),
    "rolled": lambda rng: view_of(SCENE, rng=rng, roll_deg=30.0),
}


@pytest.mark.parametrize("hardship", HARDSHIPS)
def test_the_table_is_found_and_nothing_else(hardship: str) -> None:
    view = HARDSHIPS[hardship](np.random.default_rng(1))
    (found,) = supports(view)
    assert found.position_xyz == pytest.approx([1.6, 0.1, 0.73], abs=0.04)
    assert found.measures["height"] == pytest.approx(0.73, abs=0.006)
    assert found.box.size_xyz[:2] == pytest.approx((1.2, 0.8), abs=0.09)
    assert found.pixels is not None and view.depth_m is not None
    assert (view.depth_m.ravel()[found.pixels] > 0).all()


@pytest.mark.parametrize("borders", [True, False])
@pytest.mark.parametrize("size", [(1, 1), (7, 5), (639, 479), (333, 211)])
def test_an_image_of_any_size_is_looked_at_within_its_bounds(
    size: tuple[int, int], borders: bool
) -> None:
    width, height = size
    fine = PinholeCamera(width, height, 900.0, 900.0, width / 2, height / 2)
    view = view_of(SCENE, rng=np.random.default_rng(2), camera=fine)
    assert view.depth_m is not None
    for d in SurfaceDetector(replace(SurfaceSettings(), borders=borders)).detect(view):
        if d.pixels is not None:
            assert d.pixels.min() >= 0 and d.pixels.max() < width * height
        assert d.image_box is not None
        assert d.image_box[2] <= width and d.image_box[3] <= height


@pytest.mark.parametrize("noise", [1.0, 3.0])
@pytest.mark.parametrize(
    ("things", "height", "pitch_deg"),
    [
        pytest.param([FLOOR], 1.3, 60.0, id="floor"),
        pytest.param([FLOOR], 1.3, 15.0, id="floor-to-8-m"),
        pytest.param([Box((0.32, -5.0, -1.0), (0.4, 5.0, 4.0))], 1.3, 0.0, id="wall-at-0.3-m"),
        pytest.param([Box((6.0, -9.0, -3.0), (6.1, 9.0, 9.0))], 1.3, 10.0, id="wall-at-6-m"),
    ],
)
def test_where_there_is_no_table_none_is_seen(
    things: list[Box], height: float, pitch_deg: float, noise: float
) -> None:
    rng = np.random.default_rng(6)
    for roll_deg in (0.0, 30.0):
        assert not supports(view_of(things, height, pitch_deg, rng, SMALL, roll_deg, noise))
    assert not supports(view_of(things, height, pitch_deg, rng, CAMERA, 0.0, noise))
