"""A robot that is lost looks for where what it sees fits its own map, anywhere and at any heading.

Correlative search (Olson 2009) over the whole map: one Fourier transform per heading tries all
places at once. What fits best is made exact by ICP; it must fit well, and nowhere else nearly so.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from afkb_mapping.placing.coarse_search import STEP_M, LikelihoodField
from afkb_mapping.placing.scan_matching import LocalMap, Match, refine, rotation
from afkb_mapping.placing.scan_surface import SurfacePoints
from afkb_mapping.placing.surface_map import SurfaceMap

Array = NDArray[np.float64]

HEADINGS = 120
"""Headings that are tried: 3 degrees apart, from which ICP finds the exact one."""
PLACES_PER_HEADING = 3
CANDIDATES = 8
"""So many of the best are made exact."""
APART_M, APART_RAD = 0.5, math.radians(20)
"""Candidates nearer than both of these are one."""
LEAST_POINTS = 60
"""What fewer cells of surface look like, much does."""
FOUND_OVERLAP = 0.7
"""A robot stands where so much of what it sees is on the map,"""
FOUND_OVERLAP_BY_IMAGE = 0.8
"""(a camera, which sees only part of what is around, must explain more of it)"""
FOUND_GAIN = 0.15
"""and so much more of it than anywhere else."""
STARTING_SIGMAS = (0.2, 0.2, 0.1)
"""How far the search's steps may be off (m, m, rad)."""


def relocated(
    seen: SurfacePoints,
    pivot_xy: Array,
    surface_map: SurfaceMap,
    least_overlap: float = FOUND_OVERLAP,
) -> Match | None:
    """The motion about the pivot that lays what is seen (thinned) on the map; None where unsure."""
    if len(seen) < LEAST_POINTS or not len(surface_map):
        return None
    local_map = LocalMap(surface_map.all())
    loose = np.diag(1 / np.square(STARTING_SIGMAS))
    matches = [
        refine(seen, local_map, pivot_xy, start, loose, start, (0.3, 0.15))
        for start in _starts(seen, pivot_xy, local_map.surface.points_xy)
    ]
    matches.sort(key=lambda m: -m.overlap)
    if not matches or matches[0].overlap < least_overlap:
        return None
    best = matches[0]
    others = [m.overlap for m in matches if _apart(m.motion, best.motion)]
    return best if best.overlap >= max(others, default=0.0) + FOUND_GAIN else None


def _starts(seen: SurfacePoints, pivot_xy: Array, map_xy: Array) -> list[Array]:
    """The likeliest motions (3,), best first, unlike each other."""
    field = LikelihoodField(map_xy, margin_m=1.0)
    reach = float(np.linalg.norm(seen.points_xy - pivot_xy, axis=1).max())
    around = int(np.ceil(reach / STEP_M)) + 1
    shape = [fft.next_fast_len(n + 2 * around, real=True) for n in field.votes.shape]
    votes = fft.rfft2(field.votes, shape)
    found: list[tuple[float, Array]] = []
    for heading in range(HEADINGS):
        turn = math.remainder(2 * math.pi * heading / HEADINGS, 2 * math.pi)
        offsets = (seen.points_xy - pivot_xy) @ rotation(turn).T
        cells = np.floor(offsets / STEP_M).astype(int) % shape
        hits = np.zeros(shape, np.float32)
        np.add.at(hits, (cells[:, 0], cells[:, 1]), 1 / len(cells))
        scores = fft.irfft2(votes * np.conj(fft.rfft2(hits)), shape)
        scores = scores[: field.votes.shape[0], : field.votes.shape[1]]
        for score, cell in _peaks(scores):
            place = field.origin + (np.array(cell) + 0.5) * STEP_M
            found.append((score, np.array([*(place - pivot_xy), turn])))
    found.sort(key=lambda f: -f[0])
    return _unlike([motion for _, motion in found])


def _peaks(scores: NDArray[np.floating]) -> list[tuple[float, tuple[int, int]]]:
    """The highest scores that lie further than `APART_M` from a higher one."""
    left, peaks, radius = scores.copy(), [], round(APART_M / STEP_M)
    for _ in range(PLACES_PER_HEADING):
        i, j = (int(k) for k in np.unravel_index(int(np.argmax(left)), left.shape))
        peaks.append((float(left[i, j]), (i, j)))
        left[max(i - radius, 0) : i + radius + 1, max(j - radius, 0) : j + radius + 1] = -1.0
    return peaks


def _unlike(motions: Sequence[Array]) -> list[Array]:
    kept: list[Array] = []
    for motion in motions:
        if all(_apart(motion, other) for other in kept):
            kept.append(motion)
            if len(kept) == CANDIDATES:
                break
    return kept


def _apart(a: Array, b: Array) -> bool:
    turn = abs(math.remainder(float(a[2] - b[2]), 2 * math.pi))
    return math.hypot(a[0] - b[0], a[1] - b[1]) > APART_M or turn > APART_RAD
