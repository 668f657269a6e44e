"""Percentiles of short arrays, compiled: numpy's take longer to prepare than to compute."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel

FEW = 8
"""Values so near the end of an order are found by looking for the smallest, or largest, few."""


@kernel
def kth_smallest(scratch: NDArray[np.float64], k: int) -> float:
    """The k-th smallest value, from 0; whatever stands behind it then is no smaller (Hoare)."""
    left, right = 0, len(scratch) - 1
    while left < right:
        pivot = scratch[(left + right) // 2]
        i, j = left, right
        while i <= j:
            while scratch[i] < pivot:
                i += 1
            while scratch[j] > pivot:
                j -= 1
            if i <= j:
                scratch[i], scratch[j] = scratch[j], scratch[i]
                i += 1
                j -= 1
        if k <= j:
            right = j
        elif k >= i:
            left = i
        else:
            break
    return float(scratch[k])


@kernel
def _smallest(values: NDArray[np.float64], sign: float, k: int) -> tuple[float, float]:
    """The k-th and the next smallest of sign times the values, k < FEW, in one pass."""
    kept = np.full(k + 2, np.inf)
    for n in range(len(values)):
        value = sign * values[n]
        if value < kept[k + 1]:
            i = k + 1
            while i > 0 and value < kept[i - 1]:
                kept[i] = kept[i - 1]
                i -= 1
            kept[i] = value
    return float(kept[k]), float(kept[k + 1])


@kernel
def _percentile_within(scratch: NDArray[np.float64], percent: float) -> float:
    last = len(scratch) - 1
    rank = last * (percent / 100.0)
    k = math.floor(rank)
    share = rank - k
    if k == last:
        return float(scratch.max())
    if k < FEW:
        low, high = _smallest(scratch, 1.0, k)
    elif last - k <= FEW:
        high, low = _smallest(scratch, -1.0, last - k - 1)
        low, high = -low, -high
    else:
        low = kth_smallest(scratch, k)
        high = float(scratch[k + 1])
        for n in range(k + 2, len(scratch)):
            high = min(high, float(scratch[n]))
    if share == 0.0:
        return low
    # numpy's rounding, so that the result is the same to the last bit
    return high - (high - low) * (1.0 - share) if share >= 0.5 else low + (high - low) * share


@kernel
def percentile(values: NDArray[np.number], percent: float) -> float:
    """What `numpy.percentile` gives for finite values (N,), N > 0."""
    return _percentile_within(values.astype(np.float64), percent)


@kernel
def percentiles(values: NDArray[np.floating], low: float, high: float) -> tuple[float, float]:
    """Two percentiles of finite values (N,), N > 0."""
    scratch = values.astype(np.float64)
    return _percentile_within(scratch, low), _percentile_within(scratch, high)
