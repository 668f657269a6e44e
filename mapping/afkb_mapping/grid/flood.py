"""Flooding a distance field from its peaks, compiled; imported when rooms are first segmented."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def _root(parent: NDArray[np.int32], label: int) -> int:
    while parent[label] != label:
        parent[label] = parent[parent[label]]
        label = parent[label]
    return label


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def flood(
    heights: NDArray[np.float32],
    order: NDArray[np.int64],
    widest_door: float,
    narrowing: float,
) -> NDArray[np.int32]:
    """Label basins of `heights`, in descending `order` of flat indices; 0 where not in `order`.

    Where two basins meet at height h they become one if h exceeds `widest_door`, or `narrowing`
    times the lower of their peaks; else each keeps to its side.
    """
    rows, cols = heights.shape
    labels = np.zeros((rows, cols), dtype=np.int32)
    parent = np.zeros(order.size + 1, dtype=np.int32)
    peak = np.zeros(order.size + 1, dtype=np.float32)
    count = 0
    for k in range(order.size):
        row, col = order[k] // cols, order[k] % cols
        h = heights[row, col]
        best, best_height = 0, np.float32(-1.0)
        for dr in range(-1, 2):
            for dc in range(-1, 2):
                r, c = row + dr, col + dc
                if r < 0 or r >= rows or c < 0 or c >= cols or labels[r, c] == 0:
                    continue
                label = _root(parent, labels[r, c])
                if best == 0:
                    best, best_height = label, heights[r, c]
                elif label != best:
                    lower = min(peak[label], peak[best])
                    if h > widest_door or h > narrowing * lower:
                        kept, lost = min(label, best), max(label, best)
                        parent[lost] = kept
                        peak[kept] = max(peak[kept], peak[lost])
                        best, best_height = kept, max(best_height, heights[r, c])
                    elif heights[r, c] > best_height:
                        best, best_height = label, heights[r, c]
        if best == 0:
            count += 1
            best = count
            parent[count] = count
            peak[count] = h
        labels[row, col] = best
    for k in range(order.size):
        row, col = order[k] // cols, order[k] % cols
        labels[row, col] = _root(parent, labels[row, col])
    return labels
