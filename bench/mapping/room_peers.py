"""Room segmentations of the literature, run beside ours (Bormann et al., ICRA 2016, §III).

Each takes the free cells (rows, cols) of a plan and the size of a cell, m; it returns labels, 0 =
no room. Areas and distances are those that the survey settles on.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from bench.mapping.room_scores import regions

Mask = NDArray[np.bool_]
Labels = NDArray[np.int32]

MORPHOLOGICAL_M2 = (0.8, 47.0)
"""Areas that eroding may part off as a room."""
DISTANCE_M2 = (0.35, 163.0)
"""Areas of the cores that are counted when the level is chosen."""
CRITICAL_M = 1.6
"""A critical point is the narrowest place of the Voronoi graph within this of it."""
WIDER = 1.2
"""and so much narrower than the widest place within this."""
NARROWEST_M = 0.4
"""Narrower places are corners."""
OPPOSITE = -0.5
"""Greatest cosine between the ways from a cell of the graph to the obstacles on either side: at
less than 120 degrees the graph runs into a corner."""
MERGED_BELOW_M2, MERGED_FROM = 12.5, 0.2
"""A smaller cell of the Voronoi graph is given to a neighbour that so much of its rim touches."""


def watershed(free: Mask, resolution_m: float) -> Labels:
    """Distance transform cut at the level that parts most cores, flooded from these."""
    distance = ndimage.distance_transform_edt(np.pad(free, 1))[1:-1, 1:-1]
    best, most = np.zeros(free.shape, dtype=np.int32), 0
    for level in np.arange(0.0, float(distance.max()), 1.0):
        cores, _ = ndimage.label(distance > level)
        areas = np.bincount(cores.ravel())[1:] * resolution_m**2
        count = int(((areas >= DISTANCE_M2[0]) & (areas <= DISTANCE_M2[1])).sum())
        if count > most:
            best, most = cores.astype(np.int32), count
    return _flooded(best, free)


def morphological(free: Mask, resolution_m: float) -> Labels:
    """Free space eroded step by step; what then parts off and has a room's area, is one."""
    left, cores, count = free.copy(), np.zeros(free.shape, dtype=np.int32), 0
    while left.any():
        parts, _ = ndimage.label(left)
        areas = np.bincount(parts.ravel()) * resolution_m**2
        areas[0] = 0
        for part in np.flatnonzero(areas > 0):
            if MORPHOLOGICAL_M2[0] <= areas[part] <= MORPHOLOGICAL_M2[1]:
                count += 1
                cores[parts == part] = count
        left &= cores == 0
        left = ndimage.binary_erosion(left, np.ones((3, 3)))
    return _flooded(cores, free)


def voronoi(free: Mask, resolution_m: float) -> Labels:
    """Free space cut at critical points of its Voronoi graph (Thrun 1998), small parts merged."""
    import cv2

    distance, nearest = ndimage.distance_transform_edt(np.pad(free, 1), return_indices=True)
    distance, nearest = distance[1:-1, 1:-1], nearest[:, 1:-1, 1:-1] - 1
    graph, other = _voronoi_graph(free, nearest)
    radius = round(CRITICAL_M / resolution_m)
    graph &= distance * resolution_m > NARROWEST_M / 2
    heights = np.where(graph, distance, np.inf)
    critical = graph & (heights <= ndimage.minimum_filter(heights, size=2 * radius + 1))
    critical &= ndimage.maximum_filter(distance, size=2 * radius + 1) > WIDER * distance
    cut = free.astype(np.uint8)
    for row, col in np.argwhere(critical).tolist():
        for to_row, to_col in (nearest[:, row, col].tolist(), other[:, row, col].tolist()):
            cv2.line(cut, (col, row), (to_col, to_row), 0, lineType=cv2.LINE_4)
    parts, _ = ndimage.label(cut > 0)
    return _merged(_flooded(parts.astype(np.int32), free), MERGED_BELOW_M2 / resolution_m**2)


def _voronoi_graph(free: Mask, nearest: NDArray[np.intp]) -> tuple[Mask, NDArray[np.intp]]:
    """Free cells on the graph, and (2, rows, cols) the nearest obstacle on their other side."""
    graph, other = np.zeros(free.shape, dtype=bool), nearest.copy()
    here = np.indices(free.shape)
    for axis in (0, 1):
        beside = np.roll(nearest, -1, axis=axis + 1)
        first, second = nearest - here, beside - here
        lengths = np.hypot(*first) * np.hypot(*second)
        apart = (first * second).sum(axis=0) <= OPPOSITE * lengths
        apart &= free & np.roll(free, -1, axis=axis)
        graph |= apart
        other[:, apart] = beside[:, apart]
    return graph, other


def _flooded(cores: Labels, free: Mask) -> Labels:
    """Cores grown over the free cells as waves, step by step."""
    if not cores.any():
        return regions(free)
    grown = cores.copy()
    while True:
        wave = np.where(free & (grown == 0), ndimage.maximum_filter(grown, 3), 0)
        if not wave.any():
            return grown
        grown += wave


def _merged(labels: Labels, below_cells: float) -> Labels:
    """Small cells joined with the neighbour that they touch most."""
    merged = labels.copy()
    sizes = np.bincount(merged.ravel())
    for label in np.argsort(sizes, kind="stable"):
        if label == 0 or not 0 < sizes[label] < below_cells:
            continue
        part = merged == label
        rim = ndimage.binary_dilation(part) & ~part
        beside = np.bincount(merged[rim], minlength=len(sizes))
        beside[0] = 0
        if beside.max() >= MERGED_FROM * rim.sum():
            heir = int(np.argmax(beside))
            merged[part] = heir
            sizes[heir] += sizes[label]
            sizes[label] = 0
    return merged
