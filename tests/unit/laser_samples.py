"""Rooms made of line segments, and what a laser or a depth camera sees in them."""

from __future__ import annotations

import math

import numpy as np

from afkb.flow import LaserScan, PinholeCamera, View
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


CAMERA = PinholeCamera(160, 120, 131.0, 131.0, 79.5, 59.5)
CAMERA_HEIGHT = 1.2


def depth_view(walls, pose, odom, index=0, rng=None):
    """A view with a depth image of walls and floor, of a level camera, noisy with a generator."""
    u, v = np.meshgrid(np.arange(CAMERA.width), np.arange(CAMERA.height))
    right, down = (u - CAMERA.cx) / CAMERA.fx, (v - CAMERA.cy) / CAMERA.fy
    bearings = pose[2] - np.arctan(right[0])
    to_wall = ranges(walls, pose[0], pose[1], bearings, 8.0) * np.cos(np.arctan(right[0]))
    to_floor = np.where(down > 0, CAMERA_HEIGHT / np.maximum(down, 1e-9), np.inf)
    depth = np.minimum(to_wall[None], to_floor)
    depth = np.where(depth < 8, depth, 0.0)
    if rng is not None:
        depth += (depth > 0) * rng.normal(size=depth.shape) * (0.0012 + 0.0019 * (depth - 0.4) ** 2)
    T = np.array([[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, CAMERA_HEIGHT], [0, 0, 0, 1.0]])
    T_odom_base = T_from_xy_yaw(*odom)
    return View(index, float(index), T_odom_base, depth.astype(np.float32), CAMERA, T)
