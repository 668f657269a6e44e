"""The detector that holds the ontology's groundings against what was seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox, PinholeCamera, View
from afkb.knowledge import AfNet
from afkb.testing import sample_view
from afkb_grounded.bodies import body_measures
from afkb_grounded.detector import GroundedDetector
from afkb_grounded.groundings import Grounding
from afkb_grounded.texture import texture_measures

Array = NDArray[np.float64]
CAMERA = PinholeCamera(width=320, height=240, fx=262.5, fy=262.5, cx=159.5, cy=119.5)
T_AHEAD = np.array([[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 1.0], [0, 0, 0, 1]], dtype=np.float64)
"""A camera 1 m above the floor that looks level along x."""
BASE = AfNet()
DETECTOR = GroundedDetector(BASE)


def rays() -> Array:
    v, u = np.mgrid[: CAMERA.height, : CAMERA.width]
    return np.stack([(u - CAMERA.cx) / CAMERA.fx, (v - CAMERA.cy) / CAMERA.fy, u * 0 + 1.0], -1)


def view_of(depth: Array, color: NDArray[np.uint8] | None = None) -> View:
    eye, at = np.eye(4), T_AHEAD
    return View(0, 0.0, eye, depth.astype(np.float32), CAMERA, at, color=color, T_map_base=eye)


def ball_depth(radius: float, away: float) -> Array:
    d = rays()
    a, b = (d**2).sum(-1), -2 * away * d[..., 2]
    inside = b**2 - 4 * a * (away**2 - radius**2)
    return np.where(inside > 0, (-b - np.sqrt(np.maximum(inside, 0))) / (2 * a), 0.0)


def crate_depth(side: float, away: float) -> Array:
    d = rays()
    shown = (np.abs(d[..., 0] * away) < side / 2) & (np.abs(d[..., 1] * away) < side / 2)
    return np.where(shown, away, 0.0)


def detection(size: tuple[float, float, float], z: float, **more: object) -> Detection:
    """A thing a metre ahead whose middle is `z` m above the floor."""
    xs, ys = np.meshgrid(*(np.arange(-s / 2, s / 2, 0.02) for s in size[:2]))
    said: dict[str, object] = {
        "detector": "sample",
        "affordances": {"SupportAbility": 0.95},
        "box": OrientedBox((1.0, 0.0, z), size),
        "position_xyz": np.array([1.0, 0.0, z + size[2] / 2]),
        "covariance_xyz": np.eye(3) * 1e-4,
        "footprint_xy": np.column_stack([xs.ravel() + 1.0, ys.ravel()]),
        "n_pixels": 2000,
        "range_m": 1.0,
    }
    return Detection(**(said | more))  # type: ignore[arg-type]


def body(size: float, depth: Array) -> Detection:
    pixels = np.flatnonzero(depth.ravel() > 0).astype(np.int32)
    return detection((size, size, size), 1.0, affordances={"DisposeAbility": 1.0}, pixels=pixels)


def told(found: list[Detection]) -> dict[str, float]:
    return {name: p for d in found for name, p in d.affordances.items()}


def test_a_ball_rolls_every_way_and_a_crate_does_not() -> None:
    ball, crate = ball_depth(0.12, 1.0), crate_depth(0.24, 1.0)
    rolls = told(DETECTOR.detect(view_of(ball), [body(0.24, ball)]))
    stands = told(DETECTOR.detect(view_of(crate), [body(0.24, crate)]))
    assert rolls["RollAbility3D"] == pytest.approx(0.8)
    assert "RollAbility3D" not in stands
    assert "RollAbility2D" not in stands


@pytest.mark.parametrize(
    ("height", "size", "feature"),
    [(0.45, (0.45, 0.45, 0.02), "SitAbility"), (0.5, (1.9, 0.9, 0.02), "LieAbility")],
)
def test_a_surface_affords_by_its_height_and_size(
    height: float, size: tuple[float, float, float], feature: str
) -> None:
    wall = view_of(np.full((CAMERA.height, CAMERA.width), 4.0))
    low = told(DETECTOR.detect(wall, [detection(size, height - 0.01)]))
    high = told(DETECTOR.detect(wall, [detection(size, height + 0.6)]))
    assert low[feature] > 0.7
    assert feature not in high


def test_what_a_table_is_pushed_over_is_no_seat() -> None:
    """The sample view's table top is 0.73 m high, from 1.4 to 2.2 m ahead."""
    seat = detection((0.45, 0.45, 0.02), 0.44)
    away = np.array([0.8, 0.0])
    under = replace(
        seat,
        box=OrientedBox((1.8, 0.0, 0.44), seat.box.size_xyz),
        position_xyz=np.array([1.8, 0.0, 0.45]),
        footprint_xy=seat.footprint_xy + away,
    )
    assert "SitAbility" in told(DETECTOR.detect(sample_view(), [seat]))
    assert "SitAbility" not in told(DETECTOR.detect(sample_view(), [under]))


def test_it_adds_to_what_was_seen_and_tells_hints_apart() -> None:
    depth = ball_depth(0.05, 1.0)
    found = DETECTOR.detect(view_of(depth), [detection((2, 2, 0.02), 2.0), body(0.1, depth)])
    weak = {name for name, feature in BASE.features.items() if feature.is_weak}
    assert found
    for d in found:
        is_weak = d.measures.get("weak") == 1.0
        assert d.about in (0, 1)
        assert all((name in weak) is is_weak for name in d.affordances)
        assert not is_weak or max(d.affordances.values()) < 0.5
    grasps = {n for n, p in told(found).items() if BASE.features[n].kind == "grasp" and p >= 0.5}
    assert {"PowerSphereGrasp", "LargeDiameterGrasp"} <= grasps
    assert "SmallDiameterGrasp" not in grasps


def test_nothing_is_surer_than_that_there_is_such_a_thing() -> None:
    depth = ball_depth(0.12, 1.0)
    doubtful = replace(body(0.24, depth), affordances={"DisposeAbility": 0.3})
    assert max(told(DETECTOR.detect(view_of(depth), [doubtful])).values()) <= 0.3


def test_the_worst_measure_decides_and_an_unknown_one_says_nothing() -> None:
    limits = {"height_m": (0.0, 1.0, 2.0, 3.0), "width_m": (0.0, 1.0, 2.0, 3.0)}
    grounding = Grounding("StepAbility", frozenset(("surface",)), 0.8, limits, is_weak=False)
    assert grounding.probability({"height_m": 1.5, "width_m": 0.5}) == pytest.approx(0.4)
    assert grounding.probability({"height_m": 0.5, "width_m": 0.5}) == pytest.approx(0.4)
    assert grounding.probability({"height_m": 1.5}) == 0.0


def test_a_switch_on_a_wall_is_a_part_of_it() -> None:
    d = rays()
    wall = np.full(d.shape[:2], 1.5)
    across, up = 1.5 * d[..., 0], 1.0 - 1.5 * d[..., 1]
    wall[(np.abs(across) < 0.05) & (np.abs(up - 1.1) < 0.05)] = 1.47
    bound = detection(
        (1.6, 0.02, 1.2),
        1.0,
        affordances={"BlockAbility": 0.97},
        segment_xy=np.array([[1.5, -0.8], [1.5, 0.8]]),
        image_box=(0, 0, CAMERA.width, CAMERA.height),
        range_m=1.5,
    )
    (part,) = (p for p in DETECTOR.detect(view_of(wall), [bound]) if p.about is None)
    assert part.affords("ActuateAbility", 0.25)
    assert part.box.center_xyz == pytest.approx((1.5, 0.0, 1.1), abs=0.03)
    plain = np.full(d.shape[:2], 1.5)
    assert not [p for p in DETECTOR.detect(view_of(plain), [bound]) if p.about is None]


def test_half_of_the_pixels_missing_leaves_a_ball_round() -> None:
    depth = ball_depth(0.12, 1.0)
    depth[np.random.default_rng(1).random(depth.shape) < 0.5] = 0.0
    measures = body_measures(body(0.24, depth), view_of(depth))
    assert measures["sphere_fit_rms_over_radius"] < 0.03
    assert measures["missing_depth_share"] == pytest.approx(0.5, abs=0.05)


def test_stripes_have_one_direction_and_a_mesh_two() -> None:
    across = np.tile(np.where(np.arange(80) % 8 < 4, 40, 200), (80, 1)).astype(np.uint8)
    mesh = np.where((across < 100) | (across.T < 100), 40, 200).astype(np.uint8)
    own = np.arange(80 * 80, dtype=np.int32)
    stripes, grid = (
        texture_measures(own, np.stack([image] * 3, axis=-1)) for image in (across, mesh)
    )
    assert stripes["dominant_orientation_ratio"] > 10 > stripes["grid_ratio"]
    assert grid["dominant_orientation_ratio"] < 2 < grid["grid_ratio"]
    assert texture_measures(own, None) == {}


def test_nothing_before_it_or_an_ontology_without_groundings_gives_nothing() -> None:
    assert DETECTOR.detect(sample_view(), []) == []
    silent = GroundedDetector(BASE)
    silent.__dict__.update(_groundings=[], _by_kind={})
    assert silent.detect(sample_view(), [detection((0.45, 0.45, 0.02), 0.44)]) == []
