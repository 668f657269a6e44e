"""Bounds from laser scans, and their merging into one wall each."""

from dataclasses import replace

import numpy as np
import pytest

import laser_samples as samples
from afkb.flow import LaserScan
from afkb.plugins.protocols import Detector
from afkb_laser_bounds.detector import LaserBoundDetector
from afkb_laser_bounds.segments import segments_of
from afkb_mapping.bounds import BoundMerger
from afkb_mapping.geometry import T_from_xy_yaw

POSES = [(1.5, 1.5, 0.0), (3, 3, 1.0), (2.5, 4, 2.0), (4.5, 3.95, 0.3), (7, 3, -1.0), (7, 4, 2.5)]


def detected(pose, walls=samples.FLAT, seed=0):
    rng = np.random.default_rng(seed)
    view = samples.view(walls, pose, pose, 0, rng, beams=720)
    return LaserBoundDetector().detect(replace(view, T_map_base=T_from_xy_yaw(*pose)), ())


def distance_to_walls(points, walls):
    start, span = walls[:, 0], walls[:, 1] - walls[:, 0]
    t = ((points[:, None] - start) * span).sum(2) / (span**2).sum(1)
    nearest = start + np.clip(t, 0, 1)[..., None] * span
    return np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1)


def test_is_a_detector():
    assert isinstance(LaserBoundDetector(), Detector)


def test_finds_the_walls_where_they_are():
    found = detected((1.5, 1.5, 0.7))
    assert len(found) >= 4
    for bound in found:
        assert bound.affords("BlockAbility")
        assert distance_to_walls(bound.segment_xy, samples.FLAT).max() < 0.05
        assert bound.measures["length_m"] >= 0.3


def test_tells_that_it_sees_one_height_only():
    bound = detected((1.5, 1.5, 0.0))[0]
    assert not bound.extent_known
    assert bound.box.size_xyz[2] <= 0.02
    assert bound.position_xyz[2] == pytest.approx(0.25)
    assert bound.covariance_xyz[2, 2] > 0.1


def test_covariance_is_tight_across_the_wall_and_loose_along_it():
    bound = max(detected((1.5, 1.5, 0.0)), key=lambda d: d.measures["length_m"])
    along = bound.segment_xy[1] - bound.segment_xy[0]
    along = along / np.linalg.norm(along)
    across = np.array([-along[1], along[0]])
    C = bound.covariance_xyz[:2, :2]
    assert along @ C @ along > 5 * (across @ C @ across)


def test_without_a_scan_nothing_is_found():
    view = samples.view(samples.FLAT, (1, 1, 0), (1, 1, 0), beams=8)
    assert LaserBoundDetector().detect(replace(view, T_map_base=np.eye(4)), ()) == ()


def test_views_from_many_places_make_each_wall_once():
    merger = BoundMerger()
    for i, pose in enumerate(POSES):
        for bound in detected(pose, seed=i):
            merger.add(bound, f"place-{i}")
    bounds = merger.bounds()
    long = [b for b in bounds if np.linalg.norm(np.subtract(b.end_xy, b.start_xy)) > 2.5]
    for a in long:
        for b in long:
            if a is not b:
                ends = np.array([b.start_xy, b.end_xy])
                wall = np.array([[a.start_xy, a.end_xy]])
                assert distance_to_walls(ends.mean(axis=0)[None], wall) > 0.2
    for b in bounds:
        ends = np.array([b.start_xy, b.end_xy])
        assert distance_to_walls(ends, samples.FLAT).max() < 0.06
    assert sum(b.observations for b in long) > 2 * len(long)


def test_a_doorway_stays_open_and_a_short_gap_closes():
    merger = BoundMerger()
    for x0, x1 in ((0.0, 1.0), (1.2, 2.0), (2.9, 4.0)):
        merger.add_segment(np.array([[x0, 0.0], [x1, 0.01]]), "test")
    assert [round(b.end_xy[0] - b.start_xy[0], 1) for b in merger.bounds()] == [2.0, 1.1]


def test_a_piece_that_bridges_two_walls_makes_them_one():
    merger = BoundMerger()
    for x0, x1 in ((0.0, 1.0), (2.0, 3.0), (1.1, 1.9)):
        merger.add_segment(np.array([[x0, 0.0], [x1, 0.0]]), "test")
    (bound,) = merger.bounds()
    assert sorted([bound.start_xy[0], bound.end_xy[0]]) == pytest.approx([0.0, 3.0])
    assert bound.observations == 3


def test_both_sides_of_a_wall_and_corners_stay_apart():
    merger = BoundMerger()
    merger.add_segment(np.array([[0.0, 0.0], [2.0, 0.0]]), "test")
    merger.add_segment(np.array([[0.0, 0.12], [2.0, 0.12]]), "test")
    merger.add_segment(np.array([[2.0, 0.0], [2.0, 0.5]]), "test")
    assert len(merger.bounds()) == 3


def test_the_order_of_views_does_not_change_the_walls():
    found = [b for i, pose in enumerate(POSES) for b in detected(pose, seed=i)]
    one, other = BoundMerger(), BoundMerger()
    for bound in found:
        one.add(bound)
    for bound in reversed(found):
        other.add(bound)
    assert abs(len(one.bounds()) - len(other.bounds())) <= 1


def test_a_wall_parts_what_lies_on_either_side_and_furniture_does_not():
    merger = BoundMerger()
    merger.add_segment(np.array([[0.0, -2.0], [0.0, 2.0]]), "laser-bounds")
    merger.add_segment(np.array([[3.0, -0.3], [3.0, 0.3]]), "laser-bounds")
    assert merger.part(np.array([-1.0, 0.0]), np.array([1.0, 0.5]))
    assert not merger.part(np.array([-1.0, 2.5]), np.array([1.0, 2.5]))
    assert not merger.part(np.array([2.0, 0.0]), np.array([4.0, 0.0]))


def test_a_line_known_well_outweighs_one_known_badly():
    merger = BoundMerger()
    merger.add_segment(np.array([[0.0, 0.0], [2.0, 0.0]]), "test", sigma_m=0.005)
    merger.add_segment(np.array([[0.0, 0.07], [2.0, 0.07]]), "test", sigma_m=0.08)
    (bound,) = merger.bounds()
    assert bound.start_xy[1] < 0.01


@pytest.mark.parametrize(("sigma_m", "walls"), [(0.005, 2), (0.05, 1)])
def test_covariance_says_whether_two_lines_are_one_wall(sigma_m, walls):
    merger = BoundMerger()
    merger.add_segment(np.array([[0.0, 0.0], [2.0, 0.0]]), "test", sigma_m)
    merger.add_segment(np.array([[0.5, 0.0], [1.0, 0.07]]), "test", sigma_m)
    assert len(merger.bounds()) == walls


def test_a_wall_is_known_better_the_more_often_it_is_seen():
    merger, sigmas = BoundMerger(), []
    for _ in range(4):
        merger.add_segment(np.array([[0.0, 0.0], [2.0, 0.0]]), "test", sigma_m=0.03)
        (bound,) = merger.bounds()
        sigmas.append(bound.sigmas)
    offsets, turns = np.array(sigmas).T
    assert offsets[3] == pytest.approx(offsets[0] / 2, rel=0.01)
    assert (np.diff(turns) < 0).all()


def test_a_noisy_line_is_fitted_as_by_total_least_squares():
    rng = np.random.default_rng(3)
    angles = np.arange(-0.6, 0.6, 0.01)
    ranges = 2.0 / np.cos(angles - 0.2) + rng.normal(0, 0.01, len(angles))
    scan = LaserScan(ranges.astype(np.float32), -0.6, 0.01, 0.1, 10.0)
    (segment,) = segments_of(scan)
    points = scan.points_xy - scan.points_xy.mean(axis=0)
    _, spread, axes = np.linalg.svd(points, full_matrices=False)
    assert segment.rms_m == pytest.approx(spread[1] / np.sqrt(len(points)), rel=1e-6)
    assert segment.length_m == pytest.approx(np.ptp(points @ axes[0]), rel=1e-6)
    assert segment.n_beams == len(points)
    assert segment.range_m == pytest.approx(scan.ranges_m.min(), rel=1e-6)
