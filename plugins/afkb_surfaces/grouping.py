"""Cells to surfaces: what kind each is of, which neighbours lie on one surface, and what joins."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_surfaces.cells import COUNT, DEPTH, NX, NY, NZ, SIGMA_TILT, X, Y, Z
from afkb_surfaces.noise import sigma_of

SAME_WALL_COS = np.float32(0.92)
"""A wall's normal stays this close to where it was first seen, so that corners part walls."""
NONE, FLOOR, SUPPORT, UPRIGHT = 0, 1, 2, 3
FLOOR_LABEL = 1
RIGHT, DOWN = np.int64(1), np.int64(2)
"""Bits of a link: the neighbour that lies on one surface with a cell."""
SAME, NEXT = np.int64(0), np.int64(1)
"""Cells ahead. Of a type, as literals are not, so that `_link` is compiled once."""
MOST_SLACK_RAD, MOST_UPRIGHT_SLACK_RAD = 0.35, 0.17
"""However unsure a normal is, it is never taken to be this much off."""
ZERO, ONE = np.float32(0), np.float32(1)


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
        _link(planes[r], planes[r], kinds[r], kinds[r], NEXT, step, times, RIGHT, links[r])
        if r + 1 < rows:
            _link(
                planes[r], planes[r + 1], kinds[r], kinds[r + 1], SAME, step, times, DOWN, links[r]
            )
    return links


@kernel
def _link(
    p: NDArray[np.float32],
    q: NDArray[np.float32],
    p_kinds: NDArray[np.int8],
    q_kinds: NDArray[np.int8],
    ahead: int,
    step_m: np.float32,
    noise: np.float32,
    bit: int,
    links: NDArray[np.uint8],
) -> None:
    """Set a bit where cell i of p and cell i + ahead of q are of one kind, on one surface."""
    for i in range(len(links) - ahead):
        j = i + ahead
        dx, dy, dz = q[X, j] - p[X, i], q[Y, j] - p[Y, i], q[Z, j] - p[Z, i]
        forth = abs(dx * p[NX, i] + dy * p[NY, i] + dz * p[NZ, i])
        back = abs(dx * q[NX, j] + dy * q[NY, j] + dz * q[NZ, j])
        level = min(abs(dz), max(forth, back))
        off = min(forth, back) if p_kinds[i] == UPRIGHT else level
        near = off < step_m + noise * sigma_of(min(p[DEPTH, i], q[DEPTH, j]))
        one = (p_kinds[i] >= SUPPORT) & (p_kinds[i] == q_kinds[j]) & near
        links[i] |= np.uint8(bit) if one else np.uint8(0)


@kernel
def grow(
    planes: NDArray[np.float32], kinds: NDArray[np.int8], links: NDArray[np.uint8]
) -> tuple[NDArray[np.int32], int]:
    """Connected cells of one surface: labels (rows, cols) from 1, and the highest.

    The floor is always label 1, whether it is seen or not. Filled span by span along rows.
    """
    rows, cols = kinds.shape
    labels = np.zeros((rows, cols), np.int32)
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
            facing = (planes[r0, NX, c0], planes[r0, NY, c0], planes[r0, NZ, c0])
            stack[0, 0], stack[0, 1] = r0, c0
            top = 1
            while top > 0:
                top -= 1
                r, c = stack[top, 0], stack[top, 1]
                if labels[r, c] == 0:
                    top = _fill_span(
                        planes, links, labels, r, c, count, kind == UPRIGHT, facing, stack, top
                    )
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
    planes: NDArray[np.float32],
    links: NDArray[np.uint8],
    labels: NDArray[np.int32],
    r: int,
    c: int,
    label: int,
    wall: bool,
    facing: tuple[np.float32, np.float32, np.float32],
    stack: NDArray[np.int32],
    top: int,
) -> int:
    """Label what a cell is linked with along its row, and put what joins above and below it.

    Returns the new top of the stack. Of cells that are linked with each other above or below, one
    is enough.
    """
    last = len(links) - 1
    row, names, own = links[r], labels[r], planes[r]
    over, names_over, own_over = links[max(r - 1, 0)], labels[max(r - 1, 0)], planes[max(r - 1, 0)]
    under, names_under = links[min(r + 1, last)], labels[min(r + 1, last)]
    own_under = planes[min(r + 1, last)]
    while c > 0 and row[c - 1] & RIGHT and _joins(own, names, c - 1, wall, facing):
        c -= 1
    above = below = False
    while True:
        names[c] = label
        up = r > 0 and (over[c] & DOWN) != 0 and _joins(own_over, names_over, c, wall, facing)
        down = (row[c] & DOWN) != 0 and _joins(own_under, names_under, c, wall, facing)
        if up and not (above and over[c - 1] & RIGHT):
            stack[top, 0], stack[top, 1] = r - 1, c
            top += 1
        if down and not (below and under[c - 1] & RIGHT):
            stack[top, 0], stack[top, 1] = r + 1, c
            top += 1
        above, below = up, down
        if not (row[c] & RIGHT and _joins(own, names, c + 1, wall, facing)):
            return top
        c += 1


@kernel
def _joins(
    planes: NDArray[np.float32],
    labels: NDArray[np.int32],
    c: int,
    wall: bool,
    facing: tuple[np.float32, np.float32, np.float32],
) -> bool:
    """Whether a cell of a row is free, and faces where the wall does that it may join."""
    if labels[c] != 0:
        return False
    dot = facing[0] * planes[NX, c] + facing[1] * planes[NY, c] + facing[2] * planes[NZ, c]
    return not wall or dot >= SAME_WALL_COS
