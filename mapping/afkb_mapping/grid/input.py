"""What a view tells the occupancy grid: its laser scan, or without one its depth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.geometry import back_project, transform
from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.panorama import pixel_step

OBSTACLE_HEIGHTS_M = (0.10, 1.50)
"""What a robot of a person's reach bumps into; below is floor with its noise, sills and carpets."""
FLOOR_WITHIN_M = 0.05
MAX_DEPTH_M = 4.0


def insert_view(grid: GridBuilder, view: View) -> None:
    """Take a placed view into the grid."""
    if view.scan is not None:
        grid.insert_scan(view)
        return
    if view.depth_m is None or view.camera is None:
        return
    pixels = back_project(view.depth_m, view.camera, pixel_step(view.camera)).reshape(-1, 3)
    with np.errstate(invalid="ignore"):
        seen: NDArray[np.float64] = pixels[pixels[:, 2] < MAX_DEPTH_M].astype(np.float64)
    points = transform(view.T_map_camera, seen)
    height = points[:, 2]
    low, high = OBSTACLE_HEIGHTS_M
    grid.insert_depth_obstacles(
        points[(height > low) & (height < high), :2],
        view.T_map_camera[:2, 3],
        points[np.abs(height) < FLOOR_WITHIN_M, :2],
    )
