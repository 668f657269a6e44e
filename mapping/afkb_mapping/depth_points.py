"""Points of a depth image in the map frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb.flow import View
from afkb_mapping.kernels import kernel


def intrinsics_of(view: View) -> NDArray[np.float64]:
    """fx, fy, cx, cy of a view that has a camera, pixels."""
    assert view.camera is not None
    c = view.camera
    return np.array([c.fx, c.fy, c.cx, c.cy])


def points_of_pixels(
    u: NDArray[np.int32], v: NDArray[np.int32], view: View
) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """Depths (N,) and points (N, 3), map frame, of some pixels of a view."""
    assert view.depth_m is not None
    return points_at(u, v, view.depth_m, intrinsics_of(view), view.T_map_camera)


@kernel
def points_at(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """Depths (N,) and points (N, 3), map frame, of columns u and rows v of a depth image (H, W)."""
    fx, fy, cx, cy = intrinsics
    T = T_map_camera
    depths, points = np.empty(len(u), np.float32), np.empty((len(u), 3))
    for n in range(len(u)):
        z = depth_m[v[n], u[n]]
        x, y = (u[n] - cx) / fx, (v[n] - cy) / fy
        depths[n] = z
        for k in range(3):
            points[n, k] = (T[k, 0] * x + T[k, 1] * y + T[k, 2]) * z + T[k, 3]
    return depths, points


def height_per_depth(
    intrinsics: NDArray[np.float64], T_map_camera: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Coefficients (3,) of (u, v, 1) that give a pixel's change of height per metre of depth."""
    fx, fy, cx, cy = intrinsics
    a, b, c = T_map_camera[2, :3]
    return np.array([a / fx, b / fy, c - a * cx / fx - b * cy / fy])


@kernel
def points_of_row(
    depth_m: NDArray[np.float32],
    v: int,
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
    out: NDArray[np.float32],
    u0: int,
    u1: int,
) -> None:
    """Points of row v of a depth image (H, W), map frame, into `out` (3, W): x, y and height.

    Columns u0 up to u1 are written; where nothing returned, it is the camera's place. One plain
    loop, which the compiler turns into vector instructions: with it before, a loop over pixels
    costs less than with its own arithmetic.
    """
    T = T_map_camera.astype(np.float32)
    inverse_fx, cx = np.float32(1.0 / intrinsics[0]), np.float32(intrinsics[2])
    down = np.float32((v - intrinsics[3]) / intrinsics[1])
    ax, ay, az = T[0, 1] * down + T[0, 2], T[1, 1] * down + T[1, 2], T[2, 1] * down + T[2, 2]
    kx, ky, kz = T[0, 0] * inverse_fx, T[1, 0] * inverse_fx, T[2, 0] * inverse_fx
    bx, by, bz = T[0, 3], T[1, 3], T[2, 3]
    row, xs, ys, hs = depth_m[v], out[0], out[1], out[2]
    for u in range(u0, u1):
        z, right = row[u], np.float32(u) - cx
        xs[u] = (kx * right + ax) * z + bx
        ys[u] = (ky * right + ay) * z + by
        hs[u] = (kz * right + az) * z + bz
