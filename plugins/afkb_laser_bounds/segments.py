"""Straight pieces of one laser scan: split at corners, then fitted."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from afkb.flow import LaserScan
from afkb_mapping.scan_surface import pieces_of

Array = NDArray[np.float64]

SPLIT_M = 0.05
"""A point this far from the chord makes a corner: range noise of 1 cm stays below it."""
MAX_GAP_M = 0.5
"""Between beams further apart than this a door may stand open, so a piece ends there."""
MIN_LENGTH_M = 0.3
"""Shorter pieces bound nothing: legs, bins, edges."""
MIN_BEAMS = 6
"""Fewer beams are in line by chance."""
MAX_RMS_M = 0.025
"""Greatest spread about the line: what is rougher (people, plants, curtains) is no flat bound."""


@dataclass(frozen=True, slots=True, eq=False)
class Segment:
    """`ends_xy` (2, 2) m in the laser frame, its beams, and their rms distance from it (m)."""

    ends_xy: Array
    n_beams: int
    rms_m: float
    range_m: float

    @property
    def length_m(self) -> float:
        """Distance between the ends, m."""
        return float(np.linalg.norm(self.ends_xy[1] - self.ends_xy[0]))


def segments_of(scan: LaserScan) -> list[Segment]:
    """The straight pieces of a scan, in beam order."""
    points = scan.points_xy
    if len(points) < MIN_BEAMS:
        return []
    apart = np.linalg.norm(np.diff(points, axis=0), axis=1) > MAX_GAP_M
    apart |= np.diff(pieces_of(points)) > 0
    starts = np.concatenate([[0], np.flatnonzero(apart) + 1])
    found = []
    for first, last in zip(starts, [*starts[1:], len(points)], strict=True):
        for part in _split(points[first:last]):
            segment = _fit(part)
            if segment is not None:
                found.append(segment)
    return found


def _split(points: Array) -> list[Array]:
    """Parts between corners (Douglas and Peucker's split); a corner belongs to both."""
    import cv2

    if len(points) < MIN_BEAMS:
        return []
    corners = cv2.approxPolyDP(points.astype(np.float32).reshape(-1, 1, 2), SPLIT_M, False)
    corner_set = {tuple(c) for c in corners.reshape(-1, 2).tolist()}
    at = [i for i, p in enumerate(points.astype(np.float32).tolist()) if tuple(p) in corner_set]
    return [points[a : b + 1] for a, b in pairwise(at)]


def _fit(points: Array) -> Segment | None:
    """Total least squares line through a part, or None where it is no bound."""
    if len(points) < MIN_BEAMS:
        return None
    middle = points.mean(axis=0)
    spread, axes = np.linalg.eigh(np.cov((points - middle).T, bias=True))
    along = axes[:, 1] * np.sign(axes[:, 1] @ (points[-1] - points[0]) or 1.0)
    reach = (points - middle) @ along
    rms = float(np.sqrt(max(spread[0], 0.0)))
    if np.ptp(reach) < MIN_LENGTH_M or rms > MAX_RMS_M:
        return None
    ends = middle + np.outer([reach.min(), reach.max()], along)
    return Segment(ends, len(points), rms, float(np.linalg.norm(points, axis=1).min()))
