"""What speaks against a view having been taken where it matches the map best."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.placing.scan_matching import LocalMap, Match, apply_motion
from afkb_mapping.placing.scan_surface import SurfacePoints
from afkb_mapping.placing.seen_through import LEAST_COMPARED, Comparison, compared

Array = NDArray[np.float64]

SURELY_AGREEING = 0.7
"""A scan that the map explains little of, and that shows what the map does in fewer of the
directions in which both show a surface, may have slid along a wall: it would double others."""


def compared_at(
    match: Match | None, seen: SurfacePoints, local_map: LocalMap, pivot_xy: Array
) -> Comparison:
    """The view beside the map, where it matches best; where odometry has it if it matches not."""
    if match is None:
        return compared(seen, local_map.surface, pivot_xy)
    placed = apply_motion(match.motion, pivot_xy, seen)
    return compared(placed, local_map.surface, pivot_xy + match.motion[:2])


def contradicts(
    match: Match | None, seen: SurfacePoints, local_map: LocalMap, pivot_xy: Array
) -> bool:
    """Whether what is seen contradicts the map, even where it matches best."""
    comparison = compared_at(match, seen, local_map, pivot_xy)
    return comparison.disagrees if match is None else comparison.contradicts


def is_doubtful(match: Match, seen: SurfacePoints, local_map: LocalMap, pivot_xy: Array) -> bool:
    """Whether a good part of what is seen lies beside what the map has."""
    comparison = compared_at(match, seen, local_map, pivot_xy)
    return comparison.compared >= LEAST_COMPARED and comparison.agreeing < SURELY_AGREEING


def is_confirmed(match: Match, seen: SurfacePoints, local_map: LocalMap, pivot_xy: Array) -> bool:
    """Whether the view shows enough of the map, and as the map has it."""
    comparison = compared_at(match, seen, local_map, pivot_xy)
    return comparison.compared >= LEAST_COMPARED and comparison.agreeing >= SURELY_AGREEING
