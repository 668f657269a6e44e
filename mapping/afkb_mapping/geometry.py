"""Small rigid-body and camera geometry that mapping and plugins share."""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from afkb.flow import PinholeCamera

Real = TypeVar("Real", bound=np.floating)


def back_project(
    depth_m: NDArray[np.float32], camera: PinholeCamera, step: int = 1
) -> NDArray[np.float32]:
    """Points of a depth image: (H, W, 3) float32, camera optical frame, m; NaN where no return.

    With `step`, of every step-th pixel of every step-th row.
    """
    depth = depth_m[::step, ::step]
    z = np.where(depth > 0, depth, np.nan).astype(np.float32)
    u = ((np.arange(0, camera.width, step) - camera.cx) / camera.fx).astype(np.float32)
    v = ((np.arange(0, camera.height, step) - camera.cy) / camera.fy).astype(np.float32)
    points = np.empty((*z.shape, 3), dtype=np.float32)
    np.multiply(z, u[None, :], out=points[..., 0])
    np.multiply(z, v[:, None], out=points[..., 1])
    points[..., 2] = z
    return points


def transform(T_a_b: NDArray[np.float64], points_b: NDArray[Real]) -> NDArray[Real]:
    """Points (..., 3) of frame b in frame a, in the precision they came in."""
    R, t = T_a_b[:3, :3].astype(points_b.dtype), T_a_b[:3, 3].astype(points_b.dtype)
    moved: NDArray[Real] = points_b @ R.T + t
    return moved


def transform_xy(T_a_b: NDArray[np.float64], points_xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points (N, 2) on frame b's z = 0 plane, seen from above in frame a."""
    moved: NDArray[np.float64] = points_xy @ T_a_b[:2, :2].T + T_a_b[:2, 3]
    return moved


def inverse(T_a_b: NDArray[np.float64]) -> NDArray[np.float64]:
    """T_b_a of a rigid transform (4, 4), or the inverse of any other square matrix."""
    T_b_a: NDArray[np.float64] = np.linalg.inv(T_a_b).astype(np.float64)
    return T_b_a


def yaw_of(T: NDArray[np.float64]) -> float:
    """Heading of a frame's x axis about z, rad."""
    return math.atan2(T[1, 0], T[0, 0])


def wrap_angle(angle: float) -> float:
    """The same angle in (-pi, pi]."""
    return math.pi - (math.pi - angle) % (2 * math.pi)


def T_from_xy_yaw(x: float, y: float, yaw: float) -> NDArray[np.float64]:
    """Planar pose as a 4x4 transform, m and rad."""
    T = np.eye(4)
    T[:2, :2] = [[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]]
    T[:2, 3] = x, y
    return T


def planar(T: NDArray[np.float64]) -> NDArray[np.float64]:
    """A pose's part in the floor plane: x, y and yaw of it (4, 4)."""
    return T_from_xy_yaw(float(T[0, 3]), float(T[1, 3]), yaw_of(T))
