"""Open plans that serve two purposes and that nothing divides (paper §II.F).

Where no line on which a room may end parts purposes, the border between them may lie anywhere. All
straight borders are taken for as likely as each other: the Bayes factor of two purposes over one is
the mean of what each border gives (see `segmentation.open_plan`), so that the one border out of
many across which things differ by chance counts for little.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OccupancyGrid
from afkb.knowledge import UNKNOWN_ROOM
from afkb_mapping.segmentation.open_plan import (
    LEAST_PART_M2,
    SUBSTANTIAL,
    Belief,
    Mask,
    Purpose,
    bayes_factor,
)

DIRECTIONS = 8
"""Directions of borders that are tried, evenly over half a turn."""
SURE = 1e6
"""A Bayes factor beyond doubt: parts that the network holds for contradictory are no surer."""
STEP_M = 0.5
"""Between parallel borders: what is nearer to one than this is about as wide as a chair."""


def second_purpose(
    room: Mask, grid: OccupancyGrid, purpose: Purpose, prior: Belief
) -> tuple[str, float] | None:
    """The other purpose of a room (rows, cols), and how likely it has one; None where unlikely.

    `purpose`: posterior of a part of the grid; `prior`: of any room. The likeliest purpose of the
    whole room is its first one; an unknown purpose is no second one. One purpose
    and two are as likely beforehand.
    """
    whole = purpose(room)
    if whole is None:
        return None
    first = max(whole, key=lambda r: whole[r])
    factors: list[float] = []
    weights = dict.fromkeys(sorted(set(prior) - {first, UNKNOWN_ROOM}), 0.0)
    for part in _parts(room, grid.resolution_m):
        here, there = purpose(part), purpose(room & ~part)
        if not (here and there):
            factors.append(1.0)
            continue
        factors.append(min(bayes_factor(here, there, prior), SURE))
        for other in weights:
            weights[other] += factors[-1] * (here[other] + there[other])
    mean = float(np.mean(factors)) if factors else 0.0
    if mean < SUBSTANTIAL or not any(weights.values()):
        return None
    return max(weights, key=lambda r: weights[r]), mean / (1 + mean)


def _parts(room: Mask, resolution_m: float) -> Iterator[Mask]:
    """What lies on one side of each straight border across a room, where both sides are large."""
    rows, cols = np.nonzero(room)
    cells = np.stack([cols, rows], axis=1) * resolution_m
    least = LEAST_PART_M2 / resolution_m**2
    for k in range(DIRECTIONS):
        angle = math.pi * k / DIRECTIONS
        along: NDArray[np.float64] = cells @ np.array([math.cos(angle), math.sin(angle)])
        for border in np.arange(along.min() + STEP_M, along.max(), STEP_M):
            beyond = along > border
            if least <= np.count_nonzero(beyond) <= len(beyond) - least:
                part = np.zeros_like(room)
                part[rows[beyond], cols[beyond]] = True
                yield part
