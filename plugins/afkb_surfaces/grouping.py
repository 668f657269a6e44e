"""Cells to surfaces: what kind each is of, which neighbours lie on one surface, and what joins."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_surfaces.cells import COUNT, DEPTH, NX, NY, NZ, SIGMA_TILT, X, Y, Z
from afkb_surfaces.noise import sigma_of

SAME_WALL_COS = 0.92
"""A wall's normal stays this close to where it was first seen, so that corners part walls."""
NONE, FLOOR, SUPPORT, UPRIGHT = 0, 1, 2, 3
FLOOR_LABEL = 1
RIGHT, DOWN = 1, 2
"""Bits of a link: the neighbour that lies on one surface with a cell."""
MOST_SLACK_RAD, MOST_UPRIGHT_SLACK_RAD = 0.35, 0.17
"""However unsure a normal is, it is never taken to be this much off."""
ZERO, ONE = np.float32(0), np.float32(1)
NOWHERE = np.zeros(0, np.float32)


def classify(
    planes: NDArray[np.float32], tilt_rad: float, upright_rad: float, floor_m: float, noise: float
) -> NDArray[np.int8]:
    """Kind (rows, cols) of each cell: floor, upward-facing, upright, or none of these."""
    limits = np.array(
        [math.cos(tilt_rad), math.sin(tilt_rad), math.sin(upright_rad), math.cos(upright_rad)],
        np.float32,
    )
    return _kinds(planes, limits, np.float32(floor_m), np.float32(noise))


@kernel
def _kinds(
    planes: NDArray[np.float32], limits: NDArray[np.float32], floor_m: np.float32, noise: np.float32
) -> NDArray[np.int8]:
    rows, cols = planes.shape[0], planes.shape[2]
    kinds = np.empty((rows, cols), np.int8)
    level_cos, level_sin, upright_sin, upright_cos = limits[0], limits[1], limits[2], limits[3]
    half, sixth, most = np.float32(0.5), np.float32(1 / 6), np.float32(MOST_SLACK_RAD)
    most_upright, some = np.float32(MOST_UPRIGHT_SLACK_RAD), np.float32(0.7) * noise
    for r in range(rows):
        p, out = planes[r], kinds[r]
        for c in range(cols):
            s = min(np.float32(2) * p[SIGMA_TILT, c], most)
            t = min(s, most_upright)
            # of angles this small, the first terms of sine and cosine are as good as these
            level = level_cos * (ONE - half * s * s) - level_sin * (s - sixth * s * s * s)
            upright = upright_sin * (ONE - half * t * t) + upright_cos * t
            up = p[NZ, c]
            near_floor = abs(p[Z, c]) < floor_m + some * sigma_of(p[DEPTH, c])
            kind = UPRIGHT if abs(up) < upright else NONE
            kind = (FLOOR if near_floor else SUPPORT) if up > level else kind
            out[c] = kind if p[COUNT, c] > ZERO else NONE
    return kinds


@kernel
def links_of(
    planes: NDArray[np.float32], kinds: NDArray[np.int8], step_m: float, noise: float
) -> NDArray[np.uint8]:
    """For each cell (rows, cols), whether it is one surface with the cells RIGHT and DOWN of it."""
    rows, cols = kinds.shape
    links = np.zeros((rows, cols), np.uint8)
    step, times = np.float32(step_m), np.float32(noise)
    for r in range(rows):
        p, k = planes[r], kinds[r]
        _link(p[:, :-1], p[:, 1:], k[:-1], k[1:], step, times, RIGHT, links[r, :-1])
        if r + 1 < rows:
            _link(p, planes[r + 1], k, kinds[r + 1], step, times, DOWN, links[r])
    return links


@kernel
def _link(
    p: NDArray[np.float32],
    q: NDArray[np.float32],
    p_kinds: NDArray[np.int8],
    q_kinds: NDArray[np.int8],
    step_m: np.float32,
    noise: np.float32,
    bit: int,
    links: NDArray[np.uint8],
) -> None:
    """Set a bit where cell i of p and cell i of q are of one kind and lie on one surface."""
    for i in range(len(links)):
        kind = p_kinds[i]
        if kind < SUPPORT or kind != q_kinds[i]:
            continue
        dx, dy, dz = q[X, i] - p[X, i], q[Y, i] - p[Y, i], q[Z, i] - p[Z, i]
        forth = abs(dx * p[NX, i] + dy * p[NY, i] + dz * p[NZ, i])
        back = abs(dx * q[NX, i] + dy * q[NY, i] + dz * q[NZ, i])
        off = min(forth, back) if kind == UPRIGHT else min(abs(dz), max(forth, back))
        if off < step_m + noise * sigma_of(min(p[DEPTH, i], q[DEPTH, i])):
            links[i] |= bit


@kernel
def grow(
    planes: NDArray[np.float32], kinds: NDArray[np.int8], links: NDArray[np.uint8]
) -> tuple[NDArray[np.int32], int]:
    """Connected cells of one surface: labels (rows, cols) from 1, and the highest.

    The floor is always label 1, whether it is seen or not. Filled span by span along rows.
    """
    rows, cols = kinds.shape
    labels = np.zeros((rows, cols), np.int32)
    normals = np.empty((rows, cols, 3), np.float32)
    for r in range(rows):
        for k in range(3):
            for c in range(cols):
                normals[r, c, k] = planes[r, NX + k, c]
    stack = np.empty((2 * rows * cols, 2), np.int32)
    count = FLOOR_LABEL
    for r0 in range(rows):
        for c0 in range(cols):
            kind = kinds[r0, c0]
            if kind == FLOOR:
                labels[r0, c0] = FLOOR_LABEL
            if kind < SUPPORT or labels[r0, c0] > 0:
                continue
            count += 1
            facing = normals[r0, c0] if kind == UPRIGHT else NOWHERE
            stack[0, 0], stack[0, 1] = r0, c0
            top = 1
            while top > 0:
                top -= 1
                r, c = stack[top, 0], stack[top, 1]
                if labels[r, c] == 0:
                    top = _fill_span(normals, links, labels, r, c, count, facing, stack, top)
    return labels, count


@kernel
def kinds_of_labels(
    labels: NDArray[np.int32], kinds: NDArray[np.int8], highest: int
) -> NDArray[np.int8]:
    """Kind (highest + 1,) of the cells of each label; NONE for 0."""
    out = np.zeros(highest + 1, np.int8)
    for r in range(labels.shape[0]):
        for c in range(labels.shape[1]):
            if labels[r, c] > 0:
                out[labels[r, c]] = kinds[r, c]
    return out


@kernel
def renamed(labels: NDArray[np.int32], target: NDArray[np.int32]) -> NDArray[np.int32]:
    """Labels (rows, cols) with `target` (n_labels,) in place of each."""
    out = np.empty_like(labels)
    for r in range(labels.shape[0]):
        for c in range(labels.shape[1]):
            out[r, c] = target[labels[r, c]]
    return out


@kernel
def _fill_span(
    normals: NDArray[np.float32],
    links: NDArray[np.uint8],
    labels: NDArray[np.int32],
    r: int,
    c: int,
    label: int,
    facing: NDArray[np.float32],
    stack: NDArray[np.int32],
    top: int,
) -> int:
    """Label what a cell is linked with along its row, and put what joins above and below it.

    Returns the new top of the stack. Of cells that are linked with each other above or below, one
    is enough.
    """
    row = links[r]
    while c > 0 and row[c - 1] & RIGHT and _joins(normals, labels, r, c - 1, facing):
        c -= 1
    above = below = False
    while True:
        labels[r, c] = label
        up = r > 0 and (links[r - 1, c] & DOWN) != 0 and _joins(normals, labels, r - 1, c, facing)
        down = (row[c] & DOWN) != 0 and _joins(normals, labels, r + 1, c, facing)
        if up and not (above and links[r - 1, c - 1] & RIGHT):
            stack[top, 0], stack[top, 1] = r - 1, c
            top += 1
        if down and not (below and links[r + 1, c - 1] & RIGHT):
            stack[top, 0], stack[top, 1] = r + 1, c
            top += 1
        above, below = up, down
        if not (row[c] & RIGHT and _joins(normals, labels, r, c + 1, facing)):
            return top
        c += 1


@kernel
def _joins(
    normals: NDArray[np.float32],
    labels: NDArray[np.int32],
    r: int,
    c: int,
    facing: NDArray[np.float32],
) -> bool:
    """Whether a cell is free, and faces where the wall does that it may join."""
    if labels[r, c] != 0:
        return False
    if len(facing) == 0:
        return True
    n = normals[r, c]
    dot = facing[0] * n[0] + facing[1] * n[1] + facing[2] * n[2]
    return bool(dot >= SAME_WALL_COS)
