"""Cells to surfaces, and surfaces back to pixels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma
from afkb_surfaces.cells import CELL, COUNT, DEPTH, NX, NZ, SIGMA_TILT, A, B, C, X, Z

SAME_WALL_COS = 0.92
"""A wall's normal stays this close to where it was first seen, so that corners part walls."""
NONE, FLOOR, SUPPORT, UPRIGHT = 0, 1, 2, 3


@kernel
def classify(
    cells: NDArray[np.float64], tilt_rad: float, upright_rad: float, floor_m: float
) -> NDArray[np.int8]:
    """Kind of each cell: floor, upward-facing, upright, or none of these."""
    rows, cols = cells.shape[:2]
    kinds = np.zeros((rows, cols), np.int8)
    for r in range(rows):
        for c in range(cols):
            cell = cells[r, c]
            if cell[COUNT] == 0:
                continue
            slack = min(2.0 * cell[SIGMA_TILT], 0.35)
            tilt = np.arccos(min(max(cell[NZ], -1.0), 1.0))
            if tilt < tilt_rad + slack:
                near_floor = abs(cell[Z]) < floor_m + 2.0 * depth_sigma(cell[DEPTH]) * 0.35
                kinds[r, c] = FLOOR if near_floor else SUPPORT
            elif abs(tilt - 0.5 * np.pi) < upright_rad + min(slack, 0.17):
                kinds[r, c] = UPRIGHT
    return kinds


@kernel
def _one_surface(p: NDArray[np.float64], q: NDArray[np.float64], kind: int, step_m: float) -> bool:
    """Whether two neighbouring cells of a kind lie on one surface."""
    tolerance = step_m + depth_sigma(p[DEPTH])
    forth = back = 0.0
    for k in range(3):
        d = q[X + k] - p[X + k]
        forth += d * p[NX + k]
        back += d * q[NX + k]
    if kind == UPRIGHT:
        return min(abs(forth), abs(back)) < tolerance
    return min(abs(q[Z] - p[Z]), max(abs(forth), abs(back))) < tolerance


@kernel
def _dot(p: NDArray[np.float64], q: NDArray[np.float64]) -> float:
    return p[NX] * q[NX] + p[NX + 1] * q[NX + 1] + p[NZ] * q[NZ]


@kernel
def grow(
    cells: NDArray[np.float64], kinds: NDArray[np.int8], step_m: float
) -> tuple[NDArray[np.int32], int]:
    """Connected cells of one surface: labels (rows, cols) from 1, and their number.

    The floor is always label 1, whether it is seen or not.
    """
    rows, cols = kinds.shape
    labels = np.zeros((rows, cols), np.int32)
    stack = np.empty((rows * cols, 2), np.int32)
    count = 1
    for r0 in range(rows):
        for c0 in range(cols):
            kind = kinds[r0, c0]
            if kind == FLOOR:
                labels[r0, c0] = 1
            if kind < SUPPORT or labels[r0, c0] > 0:
                continue
            count += 1
            labels[r0, c0] = count
            seed = cells[r0, c0]
            stack[0, 0], stack[0, 1] = r0, c0
            top = 1
            while top > 0:
                top -= 1
                r, c = stack[top, 0], stack[top, 1]
                for dr, dc in ((0, 1), (1, 0), (0, -1), (-1, 0)):
                    i, j = r + dr, c + dc
                    if not (0 <= i < rows and 0 <= j < cols):
                        continue
                    if labels[i, j] != 0 or kinds[i, j] != kind:
                        continue
                    if kind == UPRIGHT and _dot(seed, cells[i, j]) < SAME_WALL_COS:
                        continue
                    if _one_surface(cells[r, c], cells[i, j], kind, step_m):
                        labels[i, j] = count
                        stack[top, 0], stack[top, 1] = i, j
                        top += 1
    return labels, count


@kernel
def pixel_labels(
    depth_m: NDArray[np.float32],
    cells: NDArray[np.float64],
    labels: NDArray[np.int32],
    kinds: NDArray[np.int8],
    softness_m: float,
) -> NDArray[np.int32]:
    """Label of each pixel that lies on the plane of its cell, or of a cell next to it: (H, W).

    Pixels with no floor or support next to them keep 0: of upright planes the cells suffice.
    """
    rows, cols = labels.shape
    out = np.zeros(depth_m.shape, np.int32)
    planes, names = np.empty((9, 3)), np.empty(9, np.int32)
    for r in range(rows):
        for c in range(cols):
            n = _planes_around(r, c, cells, labels, kinds, planes, names)
            if n == 0:
                continue
            here = labels[r, c]
            p = cells[r, c]
            for v in range(r * CELL, (r + 1) * CELL):
                for u in range(c * CELL, (c + 1) * CELL):
                    z = depth_m[v, u]
                    if not z > 0:
                        continue
                    w, best = 1.0 / z, 2.5 * depth_sigma(z) + softness_m
                    if here > 0 and abs(p[A] * u + p[B] * v + p[C] - w) * z * z < best:
                        out[v, u] = here
                        continue
                    for k in range(n):
                        off = abs(planes[k, 0] * u + planes[k, 1] * v + planes[k, 2] - w) * z * z
                        if off < best:
                            best = off
                            out[v, u] = names[k]
    return out


@kernel
def _planes_around(
    r: int,
    c: int,
    cells: NDArray[np.float64],
    labels: NDArray[np.int32],
    kinds: NDArray[np.int8],
    planes: NDArray[np.float64],
    names: NDArray[np.int32],
) -> int:
    """Number of labelled cells within one cell, 0 where none is level; writes planes and labels."""
    n, level = 0, False
    for i in range(max(r - 1, 0), min(r + 2, labels.shape[0])):
        for j in range(max(c - 1, 0), min(c + 2, labels.shape[1])):
            if labels[i, j] > 0:
                level |= kinds[i, j] != UPRIGHT
                p = cells[i, j]
                planes[n, 0], planes[n, 1], planes[n, 2] = p[A], p[B], p[C]
                names[n] = labels[i, j]
                n += 1
    return n if level else 0


@kernel
def points_of(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    intrinsics: NDArray[np.float64],
    T_map_camera: NDArray[np.float64],
) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """Depths (N,) and points (N, 3) of pixels, map frame."""
    fx, fy, cx, cy = intrinsics
    T = T_map_camera
    depths, points = np.empty(len(u), np.float32), np.empty((len(u), 3))
    for n in range(len(u)):
        z = depth_m[v[n], u[n]]
        x, y = (u[n] - cx) / fx * z, (v[n] - cy) / fy * z
        depths[n] = z
        for k in range(3):
            points[n, k] = T[k, 0] * x + T[k, 1] * y + T[k, 2] * z + T[k, 3]
    return depths, points


@kernel
def label_spans(
    cells: NDArray[np.float64], labels: NDArray[np.int32], n_labels: int
) -> NDArray[np.float64]:
    """Number of cells of each label, and their lowest and highest centre, m: (n_labels, 3)."""
    spans = np.zeros((n_labels, 3))
    spans[:, 1], spans[:, 2] = np.inf, -np.inf
    for r in range(labels.shape[0]):
        for c in range(labels.shape[1]):
            k, z = labels[r, c], cells[r, c, Z]
            spans[k, 0] += 1
            spans[k, 1] = min(spans[k, 1], z)
            spans[k, 2] = max(spans[k, 2], z)
    return spans
