"""Rooms made of line segments, and the scans a laser takes in them."""

from __future__ import annotations

import math

import numpy as np

from afkb.flow import LaserScan, View
from afkb_mapping.geometry import T_from_xy_yaw

FLAT = np.array(
    [
        # Outer walls of a 9 m by 6 m flat, an inner wall with a doorway, and a cupboard.
        [[0, 0], [9, 0]],
        [[9, 0], [9, 6]],
        [[9, 6], [0, 6]],
        [[0, 6], [0, 0]],
        [[5, 0], [5, 3.5]],
        [[5, 4.4], [5, 6]],
        [[1, 5.2], [2.2, 5.2]],
        [[2.2, 5.2], [2.2, 6]],
        [[1, 5.2], [1, 6]],
    ],
    dtype=float,
)
CORRIDOR = np.array([[[-60, -1], [60, -1]], [[-60, 1], [60, 1]]], dtype=float)


def ranges(walls, x, y, angles, range_max):
    """Distance (N,) to the nearest wall along each bearing; inf beyond `range_max`."""
    start, span = walls[:, 0], walls[:, 1] - walls[:, 0]
    d = np.stack([np.cos(angles), np.sin(angles)], axis=1)[:, None]
    to = start[None] - np.array([x, y])
    cross = d[..., 0] * span[None, :, 1] - d[..., 1] * span[None, :, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        along_beam = (to[..., 0] * span[None, :, 1] - to[..., 1] * span[None, :, 0]) / cross
        along_wall = (to[..., 0] * d[..., 1] - to[..., 1] * d[..., 0]) / cross
    hit = (along_beam > 0) & (along_wall >= 0) & (along_wall <= 1)
    nearest = np.where(hit, along_beam, np.inf).min(axis=1)
    return np.where(nearest < range_max, nearest, np.inf)


def view(walls, pose, odom, index=0, rng=None, noise_m=0.01, beams=360, range_max=12.0):
    """A view with a full scan taken at `pose` (x, y, yaw), claiming the odometry `odom`."""
    angles = -math.pi + 2 * math.pi / beams * np.arange(beams)
    r = ranges(walls, pose[0], pose[1], angles + pose[2], range_max)
    if rng is not None:
        r = r + rng.normal(0, noise_m, beams)
    scan = LaserScan(r.astype(np.float32), -math.pi, 2 * math.pi / beams, 0.05, range_max)
    T_base_laser = np.eye(4)
    T_base_laser[2, 3] = 0.25
    return View(index, float(index), T_from_xy_yaw(*odom), scan=scan, T_base_laser=T_base_laser)
