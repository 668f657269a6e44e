"""Two level surfaces that growing took for one, told apart by the step between them.

The windows of cells smear a step: where two tops of nearly one height meet in the image, as those
of a couch and of a table before it, neighbouring cells differ by a third of it, which noise may
hide. All cells together show it: they lie at two heights, and few lie between.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.image_regions import order_by_label
from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma
from afkb_surfaces.cells import DEPTH, Cells, Z
from afkb_surfaces.grouping import DOWN, RIGHT, SUPPORT, grow, kinds_of_labels

Parts = tuple[NDArray[np.int64], NDArray[np.int64]]

BIN_M = 0.004
LEAST_LEVEL = 12
"""Cells that a level has at least; fewer are a thing that lies there."""
BETWEEN = 0.33
"""Where it is a step, the heights between have at most this part of the cells of either level; a
slope, or a cushion's edge, has as many at all heights."""
LEAST_INNER = 4
"""Cells that a level has amid its own: far off, where the sensor's steps are large, single rows of
cells lie at heights of their own."""
MOST_LEVELS = 3
SIDES = np.array([[1, 0], [-1, 0], [0, 1], [0, -1]], np.int64)


def grown_level(
    cells: Cells, kinds: NDArray[np.int8], links: NDArray[np.uint8], step_m: float
) -> tuple[NDArray[np.int32], NDArray[np.int8], Parts]:
    """Labels (rows, cols) of connected cells, as of `grow`, of which no support has two levels.

    Cuts the links across a step. Besides, the kind (n_labels,) of each label, and the supports'
    cells: flat indexes, label by label, and where each label begins (see `order_by_label`).
    """
    for level in range(MOST_LEVELS):
        labels, highest = grow(cells.planes, kinds, links)
        of_label = kinds_of_labels(labels, kinds, highest)
        order, starts = order_by_label(labels.ravel(), of_label == SUPPORT)
        steps = steps_of(order, starts, labels, cells.planes, step_m, cells.noise)
        if level == MOST_LEVELS - 1 or np.isnan(steps).all():
            break
        cut_steps(links, labels, cells.planes, steps)
    return labels, of_label, (order, starts)


@kernel
def steps_of(
    order: NDArray[np.int64],
    starts: NDArray[np.int64],
    labels: NDArray[np.int32],
    planes: NDArray[np.float32],
    step_m: float,
    noise: float,
) -> NDArray[np.float64]:
    """Height (n_labels,) between the two levels of a label's cells, m; nan where there is one.

    Flat indexes of the cells of label k are `order[starts[k]:starts[k + 1]]`. Levels lie farther
    apart than a step on one surface and the noise of a cell's height at that distance.
    """
    cols = planes.shape[2]
    out = np.full(len(starts) - 1, np.nan)
    for k in range(len(out)):
        own = order[starts[k] : starts[k + 1]]
        if len(own) < 2 * LEAST_LEVEL:
            continue
        z, far = np.empty(len(own)), 0.0
        for i in range(len(own)):
            r, c = own[i] // cols, own[i] % cols
            z[i] = planes[r, Z, c]
            far += planes[r, DEPTH, c]
        apart = step_m + 0.4 * noise * depth_sigma(far / len(own))
        if z.max() - z.min() > apart:
            step = _height_between(z, apart)
            if min(_count_inner(own, labels, planes, step)) >= LEAST_INNER:
                out[k] = step
    return out


@kernel
def _count_inner(
    own: NDArray[np.int64], labels: NDArray[np.int32], planes: NDArray[np.float32], step_m: float
) -> tuple[int, int]:
    """Cells below and above a height of which the four around are of their label and side."""
    rows, cols = labels.shape
    below = above = 0
    for i in range(len(own)):
        r, c = own[i] // cols, own[i] % cols
        if not (0 < r < rows - 1 and 0 < c < cols - 1):
            continue
        over, inner = planes[r, Z, c] > step_m, True
        for k in range(4):
            v, u = r + SIDES[k, 0], c + SIDES[k, 1]
            inner &= (labels[v, u] == labels[r, c]) & ((planes[v, Z, u] > step_m) == over)
        above += inner & over
        below += inner & (not over)
    return below, above


@kernel
def _height_between(z: NDArray[np.float64], apart_m: float) -> float:
    """Where the fewest heights (N,) lie between the two fullest ones; nan where it is not few."""
    low = z.min()
    bins = np.zeros(int((z.max() - low) / BIN_M) + 3, np.int64)
    for i in range(len(z)):
        bins[int((z[i] - low) / BIN_M) + 1] += 1
    n = len(bins)
    around = np.zeros(n, np.int64)
    for k in range(1, n - 1):
        around[k] = bins[k - 1] + bins[k] + bins[k + 1]
    fullest = int(around.argmax())
    second, between = 0, -1
    for way in (-1, 1):
        lowest = k = fullest
        while 0 < k + way < n - 1:
            k += way
            if around[k] < around[lowest]:
                lowest = k
            full = around[k] > max(second, LEAST_LEVEL - 1)
            few = around[lowest] <= BETWEEN * around[k]
            if full and few and abs(k - fullest) * BIN_M > apart_m:
                second, between = around[k], lowest
    return math.nan if between < 0 else low + (between - 0.5) * BIN_M


@kernel
def cut_steps(
    links: NDArray[np.uint8],
    labels: NDArray[np.int32],
    planes: NDArray[np.float32],
    steps_m: NDArray[np.float64],
) -> None:
    """Take away the links of cells whose heights lie on either side of their label's step."""
    rows, cols = labels.shape
    for r in range(rows):
        for c in range(cols):
            step = steps_m[labels[r, c]]
            if links[r, c] == 0 or math.isnan(step):
                continue
            over = planes[r, Z, c] > step
            if links[r, c] & RIGHT and (planes[r, Z, c + 1] > step) != over:
                links[r, c] &= ~np.uint8(RIGHT)
            if links[r, c] & DOWN and (planes[r + 1, Z, c] > step) != over:
                links[r, c] &= ~np.uint8(DOWN)
