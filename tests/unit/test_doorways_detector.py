"""Doorways in synthetic scans and depth images, and what only looks like one."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import depth_samples as depth
import laser_samples as laser
from afkb.flow import PinholeCamera
from afkb.knowledge import Trapezoid
from afkb.plugins.protocols import Detector
from afkb_doorways.ceiling import CeilingDetector
from afkb_doorways.detector import DoorwayDetector
from afkb_doorways.settings import DoorwaySettings
from afkb_mapping.geometry import T_from_xy_yaw

BEHIND = depth.Box((6.0, -6.0, 0.0), (6.2, 6.0, 3.0))


def walls(gap, height=3.0, sill=0.0, lintel=None):
    """A wall 3 m ahead with a gap in its middle, a room behind it."""
    half = gap / 2
    parts = [
        depth.FLOOR,
        BEHIND,
        depth.Box((3.0, -5.0, 0.0), (3.15, -half, height)),
        depth.Box((3.0, half, 0.0), (3.15, 5.0, height)),
    ]
    if sill:
        parts.append(depth.Box((3.0, -half, 0.0), (3.15, half, sill)))
    if lintel:
        parts.append(depth.Box((3.0, -half, lintel), (3.15, half, height)))
    return parts


def seen(parts, seed=0, pitch_deg=0.0):
    return depth.view_of(parts, 1.2, pitch_deg, np.random.default_rng(seed))


def likely(view, at_least=0.5):
    return [d for d in DoorwayDetector().detect(view, ()) if d.affords("PassAbility", at_least)]


def scanned(pose, segments=laser.FLAT):
    view = laser.view(segments, pose, pose, 0, np.random.default_rng(0), beams=720)
    return replace(view, T_map_base=T_from_xy_yaw(*pose))


def test_are_detectors():
    assert isinstance(DoorwayDetector(), Detector)
    assert isinstance(CeilingDetector(), Detector)


@pytest.mark.parametrize("pose", [(3, 4, 0.0), (3, 2, 1.0), (7, 3, -2.0)])
def test_finds_the_doorway_in_a_scan(pose):
    best, *others = DoorwayDetector().detect(scanned(pose), ())
    assert best.box.center_xyz[:2] == pytest.approx((5, 3.95), abs=0.08)
    assert best.measures["width"] == pytest.approx(0.9, abs=0.06)
    assert abs(np.cos(best.box.yaw)) > 0.98
    assert best.segment_xy is None
    assert best.affordances["PassAbility"] > 2 * max(
        (d.affordances["PassAbility"] for d in others), default=0
    )


def test_finds_a_door_in_depth_alone_and_its_lintel():
    (found,) = likely(seen(walls(0.8, lintel=2.0)))
    assert found.box.center_xyz[:2] == pytest.approx((3.0, 0.0), abs=0.1)
    assert found.measures["width"] == pytest.approx(0.8, abs=0.08)
    assert found.measures["lintel_height"] == pytest.approx(2.0, abs=0.05)
    assert found.measures["jambs"] == 2


def test_a_lintel_too_low_is_no_doorway():
    assert not likely(seen(walls(0.8, lintel=1.75)))
    assert likely(seen(walls(0.8, lintel=1.95)))


@pytest.mark.parametrize(
    "parts",
    [
        pytest.param(walls(0.3), id="gap of 0.3 m"),
        pytest.param(walls(3.0), id="opening of 3 m"),
        pytest.param(walls(1.2, sill=0.9, lintel=2.1), id="window"),
        pytest.param(walls(0.8, height=0.9), id="gap between counters"),
        pytest.param([*walls(0.8), depth.table(3.1, 0.0, 0.75)], id="table in the gap"),
        pytest.param([depth.FLOOR, depth.Box((1.0, -5, 0), (1.2, 5, 3))], id="blank wall"),
        pytest.param([depth.FLOOR], id="floor"),
    ],
)
def test_what_is_no_doorway(parts):
    assert not likely(seen(parts))


def test_a_niche_is_no_doorway():
    niche = depth.Box((3.4, -5.0, 0.0), (3.6, 5.0, 3.0))
    assert not DoorwayDetector().detect(seen([*walls(0.8), niche]), ())


def test_none_along_a_corridor():
    assert not DoorwayDetector().detect(scanned((0, 0, 0.0), laser.CORRIDOR), ())


@pytest.mark.parametrize("seed", [1, 2])
def test_holds_with_half_of_the_pixels_and_thrice_the_noise(seed):
    view = seen(walls(0.9, lintel=2.0))
    rng = np.random.default_rng(seed)
    noise = 2 * rng.normal(size=view.depth_m.shape) * 0.0019 * (view.depth_m - 0.4) ** 2
    worse = np.where(view.depth_m > 0, view.depth_m + noise, 0)
    worse[rng.random(worse.shape) < 0.5] = 0
    (found,) = likely(replace(view, depth_m=worse.astype(np.float32)))
    assert found.measures["width"] == pytest.approx(0.9, abs=0.12)


def test_does_not_depend_on_the_size_of_the_image():
    view, camera = seen(walls(0.8, lintel=2.0)), depth.CAMERA
    half = PinholeCamera(320, 240, camera.fx / 2, camera.fy / 2, camera.cx / 2, camera.cy / 2)
    small = replace(view, depth_m=np.ascontiguousarray(view.depth_m[::2, ::2]), camera=half)
    (found,) = likely(small)
    assert found.measures["width"] == pytest.approx(0.8, abs=0.1)


def test_widths_are_the_ontologys():
    stated = Trapezoid(2.5, 2.8, 3.2, 3.5)
    pass_ability = SimpleNamespace(parameters={"width_m": stated})
    settings = DoorwaySettings.of(SimpleNamespace(features={"PassAbility": pass_ability}))
    assert settings.width_m == (2.5, 2.8, 3.2, 3.5)
    assert settings.height_m == DoorwaySettings().height_m
    found = DoorwayDetector(settings).detect(seen(walls(3.0)), ())
    assert [round(d.measures["width"]) for d in found] == [3]


def test_finds_the_ceiling_and_its_height():
    parts = [*walls(0.8), depth.Box((-3.0, -5.0, 2.6), (6.0, 5.0, 2.8))]
    (found,) = CeilingDetector().detect(seen(parts, pitch_deg=-20.0), ())
    assert found.measures["height"] == pytest.approx(2.6, abs=0.02)
    assert found.measures["is_ceiling"]
    assert found.affords("BlockAbility")


@pytest.mark.parametrize("parts", [walls(0.8), [depth.FLOOR, depth.table(2, 0, 0.75)]])
def test_walls_and_tables_are_no_ceiling(parts):
    assert not CeilingDetector().detect(seen(parts, pitch_deg=-10.0), ())
