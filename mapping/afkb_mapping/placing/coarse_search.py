"""Correlative search (Olson 2009) for a scan whose odometry is too far off for ICP."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from afkb_mapping.placing.scan_surface import SurfacePoints

Array = NDArray[np.float64]

STEP_M = 0.1
"""Cell and shift step: ICP converges from half of it with ease."""
STEP_RAD = np.deg2rad(2.0)
"""Turn step: 0.1 m at 3 m."""
SIGMA_M = 0.15
"""Distance at which a point's vote has fallen to 0.6: somewhat above the step."""
BEAMS = 120
"""Points that vote; more of one scan say the same."""
PRIOR_WEIGHT = 0.02
"""Votes lost at one standard deviation from odometry: decides only between near ties."""


class LikelihoodField:
    """How likely a beam's end is at each cell, given the mapped surface points."""

    def __init__(self, points_xy: Array, margin_m: float) -> None:
        self.origin = points_xy.min(axis=0) - margin_m
        shape = np.ceil((points_xy.max(axis=0) + margin_m - self.origin) / STEP_M).astype(int) + 1
        free = np.ones(shape, dtype=bool)
        free[tuple(np.floor((points_xy - self.origin) / STEP_M).astype(int).T)] = False
        distance = distance_transform_edt(free) * STEP_M
        self.votes = np.exp(-0.5 * (distance / SIGMA_M) ** 2).astype(np.float32)

    def scores(self, points_xy: Array, reach: int) -> NDArray[np.float32]:
        """(2 reach + 1, 2 reach + 1) mean vote of the points for each shift in x and y, cells."""
        cells = np.floor((points_xy - self.origin) / STEP_M).astype(int)
        shifts = np.arange(-reach, reach + 1)
        rows = np.clip(cells[:, 0, None] + shifts, 0, self.votes.shape[0] - 1)
        cols = np.clip(cells[:, 1, None] + shifts, 0, self.votes.shape[1] - 1)
        voted: NDArray[np.float32] = self.votes[rows[:, :, None], cols[:, None, :]].mean(axis=0)
        return voted


def candidates(
    scan: SurfacePoints,
    map_points_xy: Array,
    pivot_xy: Array,
    reach_m: float,
    reach_rad: float,
    sigmas: Array,
    count: int = 3,
) -> list[Array]:
    """The best motions (3,) dx, dy, dyaw about the pivot, best first, unlike each other.

    `reach_m`, `reach_rad` bound the search; `sigmas` (3,) are odometry's standard deviations.
    """
    thin = scan.points_xy[:: max(1, len(scan) // BEAMS)]
    field = LikelihoodField(map_points_xy, margin_m=reach_m + 1.0)
    reach = int(np.ceil(reach_m / STEP_M))
    turns = np.arange(-np.ceil(reach_rad / STEP_RAD), np.ceil(reach_rad / STEP_RAD) + 1) * STEP_RAD
    shifts = np.arange(-reach, reach + 1) * STEP_M
    off_odometry = (shifts[:, None] / sigmas[0]) ** 2 + (shifts[None, :] / sigmas[1]) ** 2
    volume = np.stack(
        [
            field.scores((thin - pivot_xy) @ _rotation(turn).T + pivot_xy, reach)
            - PRIOR_WEIGHT * np.sqrt(off_odometry + (turn / sigmas[2]) ** 2)
            for turn in turns
        ]
    )
    return [
        np.array([shifts[ix], shifts[iy], turns[it]])
        for it, ix, iy in itertools.islice(_peaks(volume), count)
    ]


def _peaks(volume: NDArray[np.floating]) -> list[tuple[int, int, int]]:
    """Indices of the greatest values, none within two cells of a greater one."""
    order = np.argsort(volume, axis=None, kind="stable")[::-1][:200]
    peaks: list[tuple[int, int, int]] = []
    for flat in order:
        it, ix, iy = (int(i) for i in np.unravel_index(flat, volume.shape))
        if all(max(abs(it - a), abs(ix - b), abs(iy - c)) > 2 for a, b, c in peaks):
            peaks.append((it, ix, iy))
    return peaks


def _rotation(yaw: float) -> Array:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([[c, -s], [s, c]])
