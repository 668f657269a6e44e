"""Where a view's surface fits the map best: near odometry's pose, or further off if it must be."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import inverse
from afkb_mapping.placing.coarse_search import candidates
from afkb_mapping.placing.scan_matching import LocalMap, Match, agreement, apply_motion, refine
from afkb_mapping.placing.scan_surface import SurfacePoints
from afkb_mapping.placing.seen_through import compared

Array = NDArray[np.float64]

GOOD_OVERLAP = 0.7
"""A match near odometry that explains this part of a view needs no second opinion; below it, the
coarse search is asked."""
LEAST_OVERLAP = 0.15
"""Where the robot enters a room little of a view is known; this much, near odometry, will do."""
MAX_DEVIATION = 3.0
"""Standard deviations from odometry within which a match counts as near."""
JUMP_OVERLAP = 0.5
"""A match further from odometry must explain this part of the view,"""
JUMP_GAIN = 0.15
"""and this much more of it than the best near one does."""
LOOKS_THROUGH = 0.2
"""A view that looks through less than this part of what the map has was taken where odometry says:
what it doesn't share with the map is new. A slip of some size looks through more."""
REACH_M, REACH_RAD = 1.0, math.radians(30)
"""Greatest reach of the coarse search: slip and collisions within one step of a recording,"""
REACH_DEVIATIONS = 8.0
"""and its reach in standard deviations of odometry where that is less."""


def best_match(
    seen: SurfacePoints, local_map: LocalMap, pivot_xy: Array, prior: Array
) -> Match | None:
    """The match from odometry's pose; where that explains little, the coarse search's best.

    `seen`: in the map frame, as odometry places it; `prior`: (3, 3), its covariance.
    """
    nowhere, certainty = np.zeros(3), inverse(prior)
    match = refine(seen, local_map, pivot_xy, nowhere, certainty, nowhere)
    near = deviation(match, prior) <= MAX_DEVIATION
    if near and match.overlap >= GOOD_OVERLAP:
        return match
    placed = apply_motion(match.motion, pivot_xy, seen) if near else seen
    if compared(placed, local_map.surface, pivot_xy).through_share < LOOKS_THROUGH:
        return match if near and match.overlap >= LEAST_OVERLAP else None
    staying = match.overlap if near else agreement(seen, local_map)[0]
    jump = max([match, *_jumps(seen, local_map, pivot_xy, prior)], key=lambda m: m.overlap)
    if jump.overlap >= max(JUMP_OVERLAP, staying + JUMP_GAIN):
        return jump
    return match if near and match.overlap >= LEAST_OVERLAP else None


def _jumps(seen: SurfacePoints, local_map: LocalMap, pivot: Array, prior: Array) -> list[Match]:
    """Matches from wherever the coarse search finds the view to fit."""
    if not len(local_map.surface):
        return []
    sigmas = np.sqrt(np.diag(prior))
    reach = np.minimum(REACH_DEVIATIONS * sigmas, [REACH_M, REACH_M, REACH_RAD])
    map_points = local_map.surface.points_xy
    starts = candidates(seen, map_points, pivot, float(reach[:2].max()), float(reach[2]), sigmas)
    loose = np.diag(1 / reach**2)
    return [refine(seen, local_map, pivot, start, loose, start, (0.3, 0.15)) for start in starts]


def deviation(match: Match, prior: Array) -> float:
    """Mahalanobis distance of a match from odometry."""
    return math.sqrt(float(match.motion @ inverse(prior) @ match.motion))
