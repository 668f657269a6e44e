"""How much of a thing each view shows: pixels whose point lies in its box, at the true pose."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.sensor_noise import depth_sigma

ON_SUPPORT_M = 0.008
"""What is lower than this over a thing's underside may be what it stands on."""
NOISE_SIGMAS = 2.0


def pixels_in_sight(
    views: Iterable[View], things: Sequence[Mapping[str, Any]]
) -> dict[str, dict[int, int]]:
    """Of each thing, by name: how many pixels show it, by the index of the view."""
    found: dict[str, dict[int, int]] = {thing["name"]: {} for thing in things}
    for view in views:
        for thing in things:
            n = _pixels_of(view, np.array(thing["min"]), np.array(thing["max"]))
            if n > 0:
                found[thing["name"]][view.index] = n
    return found


def _pixels_of(view: View, low: NDArray[np.float64], high: NDArray[np.float64]) -> int:
    """Pixels of a view whose point lies in a box; its underside is left out."""
    assert view.depth_m is not None
    T_camera_map = np.linalg.inv(view.T_map_camera)
    margin = NOISE_SIGMAS * depth_sigma(float(np.linalg.norm((T_camera_map @ [*low, 1])[:3])))
    low, high = low - margin, high + margin
    low[2] += margin + ON_SUPPORT_M
    window = _image_of(view, T_camera_map, low, high)
    if window is None:
        return 0
    xyz = _points(view, *window)
    within = np.all((xyz >= low) & (xyz <= high), axis=-1)
    return int((within & (view.depth_m[window] > 0)).sum())


def _image_of(
    view: View,
    T_camera_map: NDArray[np.float64],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
) -> tuple[slice, slice] | None:
    """Rows and columns that a box covers; None where it is behind the camera or out of sight."""
    assert view.camera is not None
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1)
    x, y, z = T_camera_map[:3, :3] @ corners + T_camera_map[:3, 3:]
    if z.min() <= 0.1:
        return None
    c = view.camera
    u, v = c.fx * x / z + c.cx, c.fy * y / z + c.cy
    u0, u1 = max(int(u.min()), 0), min(int(u.max()) + 2, c.width)
    v0, v1 = max(int(v.min()), 0), min(int(v.max()) + 2, c.height)
    return None if u0 >= u1 or v0 >= v1 else (slice(v0, v1), slice(u0, u1))


def _points(view: View, rows: slice, columns: slice) -> NDArray[np.float64]:
    """Points (rows, columns, 3) of a window of a depth image, map frame."""
    assert view.camera is not None and view.depth_m is not None
    c, T = view.camera, view.T_map_camera
    v, u = np.mgrid[rows, columns]
    rays = np.stack([(u - c.cx) / c.fx, (v - c.cy) / c.fy, np.ones(u.shape)], axis=-1)
    points: NDArray[np.float64] = (rays * view.depth_m[rows, columns, None]) @ T[:3, :3].T
    return points + T[:3, 3]
