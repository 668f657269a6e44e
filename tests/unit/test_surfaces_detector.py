"""What the surface detector says about scenes whose geometry is known exactly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from afkb.flow import Detection, View
from afkb.knowledge import AfNet
from afkb_surfaces.cells import COUNT, A, B, C, Cells
from afkb_surfaces.detector import SurfaceDetector
from afkb_surfaces.outline import ring_area
from afkb_surfaces.settings import SurfaceSettings
from depth_samples import CAMERA, FLOOR, Box, table, view_of

WALL = Box((3.0, -5.0, 0.0), (3.2, 5.0, 2.6))


def supports(view: View) -> list[Detection]:
    found = SurfaceDetector().detect(view)
    return [d for d in found if d.affords("SupportAbility") and not d.measures.get("is_floor")]


@pytest.mark.parametrize("seed", [None, 7])
def test_a_table_is_one_support_at_its_height_and_place(seed: int | None) -> None:
    rng = None if seed is None else np.random.default_rng(seed)
    (found,) = supports(view_of([FLOOR, table(1.6, 0.1, 0.73)], rng=rng))
    assert found.position_xyz == pytest.approx([1.6, 0.1, 0.73], abs=0.03)
    assert found.measures["height"] == pytest.approx(0.73, abs=0.004)
    assert found.box.size_xyz[:2] == pytest.approx((1.2, 0.8), abs=0.06)
    assert found.extent_known and not found.cut_by_image


def test_the_footprint_covers_the_table_two_centimetres_apart() -> None:
    (found,) = supports(view_of([FLOOR, table(1.6, 0.0, 0.73)]))
    assert len(found.footprint_xy) * 0.02**2 == pytest.approx(0.96, rel=0.08)
    assert len(np.unique(found.footprint_xy, axis=0)) == len(found.footprint_xy)


def test_the_floor_is_reported_once_and_marked() -> None:
    found = SurfaceDetector().detect(view_of([FLOOR, table(1.6, 0.0, 0.73)]))
    floors = [d for d in found if d.measures.get("is_floor")]
    assert len(floors) == 1
    assert floors[0].measures["height"] == pytest.approx(0.0, abs=0.003)


def test_a_table_parted_by_what_stands_on_it_is_one_support() -> None:
    carton = Box((1.2, -0.15, 0.73), (1.5, 0.15, 1.25))
    (found,) = supports(view_of([FLOOR, table(1.6, 0.0, 0.73), carton]))
    assert found.box.size_xyz[0] == pytest.approx(1.2, abs=0.06)


def test_two_tables_with_the_floor_seen_between_them_stay_two() -> None:
    left, right = table(1.6, -0.45, 0.73, width=0.7), table(1.6, 0.45, 0.73, width=0.7)
    assert len(supports(view_of([FLOOR, left, right]))) == 2


@pytest.mark.parametrize("step_m, tops", [(0.0, 1), (0.03, 2), (0.05, 2)])
def test_a_top_seen_over_a_slightly_higher_one_is_another(step_m: float, tops: int) -> None:
    low = Box((3.0, -1.0, 0.0), (3.9, 1.0, 0.42))
    high = Box((2.4, -0.5, 0.0), (3.0, 0.5, 0.42 + step_m))
    rng = np.random.default_rng(5)
    found = supports(view_of([FLOOR, low, high], pitch_deg=15, rng=rng))
    heights = sorted(d.measures["height"] for d in found)
    assert heights == pytest.approx([0.42, 0.42 + step_m][-tops:], abs=0.004)


def test_a_wall_blocks_and_does_not_support() -> None:
    found = SurfaceDetector().detect(view_of([FLOOR, WALL], pitch_deg=10))
    (wall,) = [d for d in found if d.affords("BlockAbility")]
    assert wall.segment_xy is not None
    assert wall.segment_xy[:, 0] == pytest.approx([3.0, 3.0], abs=0.02)
    assert abs(np.diff(wall.segment_xy[:, 1])[0]) > 3.0
    assert not supports(view_of([FLOOR, WALL], pitch_deg=10))


def test_a_table_cut_by_the_image_says_so() -> None:
    (found,) = supports(view_of([FLOOR, table(1.6, 1.2, 0.73)]))
    assert found.cut_by_image


@pytest.mark.parametrize("pitch_deg", [0.0, 20.0])
def test_a_blank_wall_that_fills_the_view_gives_no_support(pitch_deg: float) -> None:
    near = Box((0.9, -5.0, -1.0), (1.0, 5.0, 4.0))
    rng = np.random.default_rng(3)
    assert not supports(view_of([near], pitch_deg=pitch_deg, rng=rng))


def test_a_top_that_returns_next_to_nothing_has_no_known_extent() -> None:
    view = view_of([FLOOR, table(1.6, 0.0, 0.9)])
    assert view.depth_m is not None
    depth = view.depth_m.copy()
    rows = np.flatnonzero(np.abs(depth[:, 320] - 1.75) < 0.5)
    depth[rows[0] : rows[0] + 40] = 0
    depth[rows[0] + 70 :] = 0
    sparse = View(0, 0.0, np.eye(4), depth, CAMERA, view.T_base_camera, T_map_base=np.eye(4))
    assert all(not d.extent_known for d in supports(sparse))


def test_hardly_any_depth_is_no_crash_and_no_table() -> None:
    depth = np.zeros((480, 640), np.float32)
    depth[200:203, 300:303] = 1.5
    view = view_of([FLOOR])
    lonely = View(0, 0.0, np.eye(4), depth, CAMERA, view.T_base_camera, T_map_base=np.eye(4))
    assert SurfaceDetector().detect(lonely) == []


def test_a_cell_plane_is_the_least_squares_fit_of_inverse_depth() -> None:
    view = view_of([FLOOR], rng=np.random.default_rng(5))
    assert view.depth_m is not None
    intrinsics = np.array([CAMERA.fx, CAMERA.fy, CAMERA.cx, CAMERA.cy])
    planes = Cells.of(view.depth_m, intrinsics, view.T_map_camera, 0.004, 1).planes
    r, c = 90, 80
    assert planes[r, COUNT, c] > 0
    v, u = np.mgrid[4 * r - 4 : 4 * r + 8, 4 * c - 4 : 4 * c + 8].reshape(2, -1)
    z = view.depth_m[v, u].astype(float)
    design = np.column_stack([u, v, np.ones(len(u))])[z > 0]
    expected, *_ = np.linalg.lstsq(design, 1 / z[z > 0], rcond=None)
    found = design @ planes[r, [A, B, C], c]
    assert found == pytest.approx(design @ expected, rel=1e-4)


def test_a_table_has_a_border_rings_and_pixels_that_are_its_own() -> None:
    (found,) = supports(view_of([FLOOR, table(1.6, 0.0, 0.73)], rng=np.random.default_rng(2)))
    assert found.border["real"] > 0.95
    assert sum(found.border.values()) == pytest.approx(1.0)
    (ring,) = found.rings_xy
    assert ring_area(ring) == pytest.approx(0.96, rel=0.03)
    assert ring.min(axis=0) == pytest.approx([1.2, -0.6], abs=0.015)
    exact = view_of([table(1.6, 0.0, 0.73)]).depth_m
    assert exact is not None and found.pixels is not None
    assert len(found.pixels) == found.n_pixels
    assert (exact.ravel()[found.pixels] > 0).mean() > 0.995


def test_what_stands_before_a_table_occludes_it_and_makes_no_hole() -> None:
    screen = Box((0.9, -0.2, 0.0), (0.95, 0.2, 0.95))
    (found,) = supports(view_of([FLOOR, table(1.6, 0.0, 0.73), screen]))
    assert found.border["occluded"] > 0.1
    assert len(found.rings_xy) == 1


def test_without_borders_a_table_is_smaller_by_a_cell_at_most() -> None:
    detector = SurfaceDetector(replace(SurfaceSettings(), borders=False))
    view = view_of([FLOOR, table(1.6, 0.1, 0.73)], rng=np.random.default_rng(3))
    _, found = (d for d in detector.detect(view) if d.affords("SupportAbility"))
    assert found.position_xyz == pytest.approx([1.6, 0.1, 0.73], abs=0.05)
    assert found.box.size_xyz[:2] == pytest.approx((1.2, 0.8), abs=0.1)
    assert ring_area(found.rings_xy[0]) == pytest.approx(0.96, rel=0.2)


def test_a_blind_border_of_the_sensor_cuts_what_reaches_it() -> None:
    view = view_of([FLOOR, table(1.6, -0.75, 0.73)])
    assert view.depth_m is not None
    depth = view.depth_m.copy()
    depth[:, -8:] = 0
    blind = View(0, 0.0, np.eye(4), depth, CAMERA, view.T_base_camera, T_map_base=np.eye(4))
    (found,) = supports(blind)
    assert found.image_box is not None and found.image_box[2] == 632
    assert found.cut_by_image
    assert found.border["cut"] > 0.05
    assert found.border["missing"] < 0.01


def test_limits_come_from_the_ontology() -> None:
    knowledge_base = AfNet()
    limits = knowledge_base.features["SupportAbility"].parameters["normal_to_up_deg"]
    settings = SurfaceSettings.from_knowledge(knowledge_base)
    assert settings.normal_to_up_deg == (limits.z1, limits.n1, limits.n2, limits.z2)


def test_the_same_view_gives_the_same_detections() -> None:
    view = view_of([FLOOR, table(1.6, 0.1, 0.73)], rng=np.random.default_rng(1))
    first, second = SurfaceDetector().detect(view), SurfaceDetector().detect(view)
    assert [d.position_xyz.tolist() for d in first] == [d.position_xyz.tolist() for d in second]
