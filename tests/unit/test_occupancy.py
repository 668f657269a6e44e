"""The occupancy grid from beams, depth and drawn things."""

from dataclasses import replace

import numpy as np
import pytest

import laser_samples as samples
from afkb.errors import BadFrame
from afkb.flow import OccupancyGrid, PinholeCamera
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_mapping.grid.occupancy import GridBuilder, rasterise
from afkb_mapping.grid.rays import trace_beams


def at(grid, x, y):
    col, row = np.floor((np.array([x, y]) - grid.origin_xy) / grid.resolution_m).astype(int)
    return grid.probability[row, col]


def scanned(poses, range_max=12.0):
    builder = GridBuilder()
    for i, pose in enumerate(poses):
        view = samples.view(samples.FLAT, pose, pose, i, beams=720, range_max=range_max)
        builder.insert_scan(replace(view, T_map_base=T_from_xy_yaw(*pose)))
    return builder.grid()


def test_walls_are_occupied_and_rooms_are_free():
    grid = scanned([(2, 2, 0), (2.5, 2.5, 1), (3, 3, 2)])
    assert at(grid, 3, 1) < 0.25
    assert at(grid, 0.0, 2.025) > 0.8 or at(grid, -0.01, 2.025) > 0.8
    assert np.isnan(at(grid, 5.5, 1.0))


def test_grows_and_keeps_what_it_knew():
    one = scanned([(2, 2, 0)], 3.0)
    two = scanned([(2, 2, 0), (7, 4, 0), (7, 2, 0)], 3.0)
    assert two.probability.shape[1] > one.probability.shape[1]
    assert at(two, 2, 1) == at(one, 2, 1)
    assert at(two, 8, 1) < 0.5


def test_many_views_leave_cells_within_the_clamp():
    grid = scanned([(2, 2, 0.1 * i) for i in range(30)])
    known = grid.probability[np.isfinite(grid.probability)]
    assert known.min() > 0.02
    assert known.max() < 0.98


def test_a_beam_marks_the_cells_that_dense_samples_of_it_touch():
    rng = np.random.default_rng(6)
    for _ in range(20):
        sensor, end = rng.uniform(1, 39, 2), rng.uniform(1, 39, 2)
        verdict = np.zeros((40, 40), np.int8)
        trace_beams(verdict, sensor, end[None], np.array([True]))
        steps = sensor + np.linspace(0, 1, 4000)[:, None] * (end - sensor)
        reference = np.zeros_like(verdict)
        reference[steps[:, 1].astype(int), steps[:, 0].astype(int)] = -1
        reference[int(end[1]), int(end[0])] = 1
        # Corners clipped by less than a sample step may differ.
        assert (verdict != reference).sum() <= 2
        assert verdict[int(end[1]), int(end[0])] == 1


def test_depth_without_floor_clears_the_way_to_obstacles():
    builder = GridBuilder()
    builder.insert_depth_obstacles(np.array([[2.02, 0.02]]), np.array([0.02, 0.02]))
    grid = builder.grid()
    assert at(grid, 1, 0.02) < 0.5
    assert at(grid, 2.02, 0.02) > 0.5


def test_floor_pixels_are_free_and_obstacles_beat_them():
    builder = GridBuilder()
    floor = np.array([[1.02, 0.02], [2.02, 0.02]])
    builder.insert_depth_obstacles(np.array([[2.02, 0.02]]), np.array([0.0, 0.0]), floor)
    grid = builder.grid()
    assert at(grid, 1.02, 0.02) < 0.5
    assert at(grid, 2.02, 0.02) > 0.5
    assert np.isnan(at(grid, 1.52, 0.02))


def test_an_empty_grid_is_one_unknown_cell():
    grid = GridBuilder().grid()
    assert grid.probability.shape == (1, 1)
    assert np.isnan(grid.probability).all()


def test_a_view_without_scan_is_refused():
    view = samples.view(samples.FLAT, (2, 2, 0), (2, 2, 0))
    depth = np.ones((2, 2), np.float32)
    camera = PinholeCamera(2, 2, 1, 1, 1, 1)
    view = replace(view, scan=None, depth_m=depth, camera=camera, T_base_camera=np.eye(4))
    with pytest.raises(BadFrame, match="no laser scan"):
        GridBuilder().insert_scan(view)


def test_drawn_things_raise_cells_and_never_lower_them():
    grid = OccupancyGrid(np.full((20, 20), 0.9, np.float32), 0.05, (0.0, 0.0))
    free = OccupancyGrid(np.full((20, 20), 0.1, np.float32), 0.05, (0.0, 0.0))
    square = np.array([[0.2, 0.2], [0.6, 0.2], [0.6, 0.6], [0.2, 0.6]])
    assert at(rasterise(free, square, 0.65), 0.4, 0.4) == pytest.approx(0.65)
    assert at(rasterise(free, square, 0.65), 0.8, 0.8) == pytest.approx(0.1)
    assert at(rasterise(grid, square, 0.65), 0.4, 0.4) == pytest.approx(0.9)


def test_things_beyond_the_edge_extend_the_grid():
    free = OccupancyGrid(np.full((20, 20), 0.1, np.float32), 0.05, (0.0, 0.0))
    square = np.array([[-0.5, 0.2], [0.1, 0.2], [0.1, 0.6], [-0.5, 0.6]])
    drawn = rasterise(free, square, 0.7)
    assert at(drawn, -0.3, 0.4) == pytest.approx(0.7)
    assert at(drawn, 0.5, 0.5) == pytest.approx(0.1)
    assert np.isnan(at(drawn, -0.3, 0.9))


def test_rounding_at_cell_edges_leads_no_beam_out_of_the_window(monkeypatch):
    """The compiled kernel checks no bounds; as plain Python it raises where one is crossed."""
    monkeypatch.setattr("afkb_mapping.grid.rays.trace_beams", trace_beams.py_func)
    for sensor_y in (-0.3, -0.2, -0.1, 0.1, 0.2):
        angles = -np.pi + 2 * np.pi / 360 * np.arange(360)
        ends = np.column_stack([3 * np.cos(angles), sensor_y + 3 * np.sin(angles)])
        builder = GridBuilder()
        builder.insert_depth_obstacles(ends, np.array([0.0, sensor_y]))
        assert not builder.unknown(np.array([[0.0, sensor_y]]))[0]
