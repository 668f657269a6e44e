"""Upright planes: what blocks the way (block-ability) and bounds a room."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox
from afkb_mapping.image_regions import Rectangle, is_cut
from afkb_mapping.kernels import kernel
from afkb_mapping.order_statistics import percentiles
from afkb_mapping.sensor_noise import depth_sigma
from afkb_mapping.trapezoids import membership
from afkb_surfaces.cells import DEPTH, Cells, X, Y, Z
from afkb_surfaces.settings import SurfaceSettings

SAMPLES = 300
"""Cells of a wall that are looked at; more would tell no more."""

CELLS, LOW, HIGH, SIZE, NEAREST, MEDIAN, X0, Y0, X1, Y1, RMS, C0, C1, R0, R1 = range(15)
"""Number of cells; lowest and highest height and the size of a cell, m; nearest and median depth,
m; ends of the segment, m; rms about it, m; the span in cells, both ends included."""
N_MEASURES = 15


@kernel
def measure_walls(
    order: NDArray[np.int64],
    starts: NDArray[np.int64],
    wanted: NDArray[np.bool_],
    planes: NDArray[np.float32],
    least_cells: int,
    least_height_m: float,
    cell_rad: float,
) -> NDArray[np.float64]:
    """Measures (n_labels, N_MEASURES); CELLS is 0 for those not wanted or too small.

    Flat indexes of the cells of label k are `order[starts[k]:starts[k + 1]]`.
    """
    out = np.zeros((len(starts) - 1, N_MEASURES))
    cols = planes.shape[2]
    for k in range(len(out)):
        n = starts[k + 1] - starts[k]
        if n < least_cells or not wanted[k]:
            continue
        m = out[k]
        thin = (n + SAMPLES - 1) // SAMPLES
        p = np.empty(((n + thin - 1) // thin, 4))
        first, last = order[starts[k]] // cols, order[starts[k + 1] - 1] // cols
        left, right, r = cols, -1, first
        for i in range(n):
            while order[starts[k] + i] >= (r + 1) * cols:
                r += 1
            c = order[starts[k] + i] - r * cols
            left, right = min(left, c), max(right, c)
            if i % thin == 0:
                q = p[i // thin]
                q[0], q[1] = planes[r, X, c], planes[r, Y, c]
                q[2], q[3] = planes[r, Z, c], planes[r, DEPTH, c]
        m[C0], m[C1], m[R0], m[R1] = left, right, first, last
        low, high = percentiles(p[:, 2], 1.0, 99.0)
        m[NEAREST], m[MEDIAN] = percentiles(p[:, 3], 1.0, 50.0)
        m[SIZE] = cell_rad * m[MEDIAN]
        m[LOW], m[HIGH] = low - 0.5 * m[SIZE], high + 0.5 * m[SIZE]
        if m[HIGH] - m[LOW] < least_height_m:
            continue
        m[CELLS] = n
        m[X0], m[Y0], m[X1], m[Y1], m[RMS] = fitted_segment(p, m[SIZE])
    return out


@kernel
def fitted_segment(
    xy: NDArray[np.float64], margin_m: float
) -> tuple[float, float, float, float, float]:
    """Ends x0, y0, x1, y1 of the line through points (N, 2+) seen from above, and rms about it, m.

    It runs along the widest spread of the points, strays left out.
    """
    n = len(xy)
    mx, my = xy[:, 0].sum() / n, xy[:, 1].sum() / n
    xx = cross = yy = 0.0
    for k in range(n):
        dx, dy = xy[k, 0] - mx, xy[k, 1] - my
        xx, cross, yy = xx + dx * dx, cross + dx * dy, yy + dy * dy
    turn = 0.5 * math.atan2(2.0 * cross, xx - yy)
    ax, ay = math.cos(turn), math.sin(turn)
    t, total = np.empty(n), 0.0
    for k in range(n):
        dx, dy = xy[k, 0] - mx, xy[k, 1] - my
        t[k] = dx * ax + dy * ay
        total += (dy * ax - dx * ay) ** 2
    start, end = percentiles(t, 0.5, 99.5)
    start, end = start - 0.5 * margin_m, end + 0.5 * margin_m
    return mx + start * ax, my + start * ay, mx + end * ax, my + end * ay, math.sqrt(total / n)


def upright_detections(
    measures: NDArray[np.float64],
    cells: Cells,
    returning: Rectangle,
    settings: SurfaceSettings,
    detector: str,
) -> Iterator[Detection]:
    """The bounds that measures (n, N_MEASURES) of upright cells speak of.

    A bound's height is what is seen of it; where the image cuts it, that is a lower bound.
    """
    size, whole = cells.size_px, _to_cells(returning, cells.size_px)
    places, covariances = _places(measures, cells.noise)
    for m, place, covariance in zip(measures.tolist(), places, covariances, strict=True):
        tall, length = m[HIGH] - m[LOW], math.hypot(m[X1] - m[X0], m[Y1] - m[Y0])
        p = membership(tall, settings.bound_height_m)
        if p <= 0 or length * tall < settings.bound_area_m2:
            continue
        x0, y0, x1, y1 = m[X0 : Y1 + 1]
        middle, yaw = tuple(place.tolist()), math.atan2(y1 - y0, x1 - x0)
        c0, c1, r0, r1 = (int(v) for v in m[C0 : R1 + 1])
        image_box = (c0 * size, r0 * size, (c1 + 1) * size, (r1 + 1) * size)
        box_m = (length, 0.02 + 2 * m[RMS], m[HIGH] - max(m[LOW], 0.0))
        yield Detection(
            detector=detector,
            affordances={"BlockAbility": 0.97 * p},
            box=OrientedBox(middle, box_m, yaw),
            position_xyz=place,
            covariance_xyz=covariance,
            footprint_xy=_along(x0, y0, x1, y1, max(2, int(length / settings.footprint_step_m))),
            n_pixels=int(m[CELLS]) * size * size,
            range_m=m[NEAREST],
            image_box=image_box,
            segment_xy=np.array([[x0, y0], [x1, y1]]),
            cut_by_image=is_cut(image_box, whole),
            measures={"height": tall, "length": length, "rms": m[RMS]},
        )


@kernel
def _places(
    measures: NDArray[np.float64], noise: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Middles (n, 3) of bounds, m, and how sure they are (n, 3, 3), m²."""
    places, covariances = np.empty((len(measures), 3)), np.zeros((len(measures), 3, 3))
    for n in range(len(measures)):
        m = measures[n]
        places[n, 0], places[n, 1] = (m[X0] + m[X1]) / 2, (m[Y0] + m[Y1]) / 2
        places[n, 2] = (max(m[LOW], 0.0) + m[HIGH]) / 2
        across = (noise * depth_sigma(m[MEDIAN])) ** 2 + 1e-4
        covariances[n, 0, 0] = covariances[n, 1, 1] = across
        covariances[n, 2, 2] = 0.01
    return places, covariances


@kernel
def _along(x0: float, y0: float, x1: float, y1: float, n: int) -> NDArray[np.float64]:
    """Points (n, 2) evenly from one to the other."""
    out = np.empty((n, 2))
    for k in range(n):
        t = k / (n - 1)
        out[k, 0], out[k, 1] = x0 + t * (x1 - x0), y0 + t * (y1 - y0)
    return out


def _to_cells(returning: Rectangle, size: int) -> Rectangle:
    """The part of a rectangle that whole cells cover, px: what cells can reach."""
    u0, v0, u1, v1 = returning
    return -(-u0 // size) * size, -(-v0 // size) * size, u1 // size * size, v1 // size * size
