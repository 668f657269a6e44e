"""Synthetic views of a room with a table, exact and the same on every machine.

The room is 5 m by 4 m with walls of 2.5 m; a table (1.2 m by 0.8 m, top at 0.73 m) stands
ahead of the robot and carries an open box and a closed one; a laser at 0.3 m sees all round.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from afkb.flow import LaserScan, PinholeCamera, View

_Boxes = NDArray[np.float64]
TABLE_HEIGHT_M = 0.73
_CAMERA = PinholeCamera(width=320, height=240, fx=262.5, fy=262.5, cx=159.5, cy=119.5)
_CAMERA_HEIGHT_M, _CAMERA_PITCH = 1.25, 0.45
_LASER_HEIGHT_M, _BEAMS = 0.30, 720
_BEAM_STEP = 2 * math.pi / _BEAMS


def _boxes() -> _Boxes:
    """(N, 2, 3) lowest and highest corner of every box in the room, m, map frame."""
    top = TABLE_HEIGHT_M
    room = [
        [[-2, -3, -0.1], [5, 3, 0.0]],
        [[-1.1, -2.1, 0], [-1.0, 2.1, 2.5]],
        [[4.0, -2.1, 0], [4.1, 2.1, 2.5]],
        [[-1.1, -2.1, 0], [4.1, -2.0, 2.5]],
        [[-1.1, 2.0, 0], [4.1, 2.1, 2.5]],
    ]
    table = [[[1.4, -0.6, top - 0.04], [2.2, 0.6, top]]]
    table += [[[x, y, 0], [x + 0.05, y + 0.05, top]] for x in (1.42, 2.13) for y in (-0.58, 0.53)]
    closed = [[[1.60, 0.20, top], [1.75, 0.42, top + 0.16]]]
    return np.array(room + table + closed + _open_box(1.55, -0.3, 0.2, 0.1), dtype=np.float64)


def _open_box(x: float, y: float, size: float, height: float) -> list[list[list[float]]]:
    """A box without a lid on the table, from a bottom and four sides of 8 mm."""
    low, high, t = TABLE_HEIGHT_M, TABLE_HEIGHT_M + height, 0.008
    return [
        [[x, y, low], [x + size, y + size, low + t]],
        [[x, y, low], [x + t, y + size, high]],
        [[x + size - t, y, low], [x + size, y + size, high]],
        [[x, y, low], [x + size, y + t, high]],
        [[x, y + size - t, low], [x + size, y + size, high]],
    ]


def _cast(origin: NDArray[np.float64], rays: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N,) how many times its own length each ray (N, 3) goes before it hits; inf where nothing."""
    nearest = np.full(len(rays), np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / rays
        for low, high in _boxes():
            a, b = (low - origin) * inverse, (high - origin) * inverse
            enter = np.nanmax(np.minimum(a, b), axis=1)
            leave = np.nanmin(np.maximum(a, b), axis=1)
            hit = (enter > 1e-6) & (enter <= leave)
            nearest = np.where(hit & (enter < nearest), enter, nearest)
    return nearest


def _pose(x: float, y: float, yaw: float) -> NDArray[np.float64]:
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]], dtype=np.float64)


def _base_camera() -> NDArray[np.float64]:
    """Optical frame on the base: ahead, tilted down."""
    c, s = math.cos(_CAMERA_PITCH), math.sin(_CAMERA_PITCH)
    columns = [[0, -s, c, 0.1], [-1, 0, 0, 0], [0, -c, -s, _CAMERA_HEIGHT_M], [0, 0, 0, 1]]
    return np.array(columns, dtype=np.float64)


def _base_laser() -> NDArray[np.float64]:
    T_base_laser = np.eye(4)
    T_base_laser[2, 3] = _LASER_HEIGHT_M
    return T_base_laser


def _depth(T_map_camera: NDArray[np.float64]) -> NDArray[np.float32]:
    v, u = np.mgrid[: _CAMERA.height, : _CAMERA.width]
    rays = np.stack([(u - _CAMERA.cx) / _CAMERA.fx, (v - _CAMERA.cy) / _CAMERA.fy, u * 0 + 1.0], -1)
    z = _cast(T_map_camera[:3, 3], rays.reshape(-1, 3) @ T_map_camera[:3, :3].T)
    z = np.where(np.isfinite(z), z, 0).reshape(_CAMERA.height, _CAMERA.width)
    return z.astype(np.float32)


def _ranges(T_map_laser: NDArray[np.float64]) -> NDArray[np.float32]:
    angles = -math.pi + _BEAM_STEP * np.arange(_BEAMS)
    rays = np.stack([np.cos(angles), np.sin(angles), 0 * angles], -1) @ T_map_laser[:3, :3].T
    return _cast(T_map_laser[:3, 3], rays).astype(np.float32)


@lru_cache(maxsize=8)
def _sensed(x: float, y: float, yaw: float) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Depth (H, W) and laser ranges (N,) from there; whoever hands them out copies them."""
    T_map_base = _pose(x, y, yaw)
    return _depth(T_map_base @ _base_camera()), _ranges(T_map_base @ _base_laser())


def sample_view(
    x: float = 0.0, y: float = 0.0, yaw: float = 0.0, index: int = 0, *, placed: bool = True
) -> View:
    """What the robot senses with its base there (m, rad): depth and a 360° scan, no noise.

    The view is placed in the map frame, as detectors and mappers get it; with `placed=False`
    it is as a source gives it.
    """
    T_map_base = _pose(x, y, yaw)
    depth_m, ranges_m = _sensed(x, y, yaw)
    return View(
        index=index,
        stamp=0.1 * index,
        T_odom_base=T_map_base,
        depth_m=depth_m.copy(),
        camera=_CAMERA,
        T_base_camera=_base_camera(),
        scan=LaserScan(ranges_m.copy(), -math.pi, _BEAM_STEP, range_min_m=0.05, range_max_m=30.0),
        T_base_laser=_base_laser(),
        T_map_base=T_map_base if placed else None,
    )


def sample_views() -> tuple[View, ...]:
    """The table from three sides."""
    poses = ((0.0, 0.0, 0.0), (0.2, 0.9, -0.4), (0.2, -0.9, 0.4))
    return tuple(sample_view(x, y, yaw, index=i) for i, (x, y, yaw) in enumerate(poses))
