"""Grounds block-ability in a laser scan: what stands in the way, at the one height it sees."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox, View
from afkb_laser_bounds.segments import Segment, segments_of
from afkb_mapping.geometry import transform_xy

Array = NDArray[np.float64]

SURE_LENGTH_M = 1.0
"""From this length on a straight piece is a wall or as good as one (Fig. 1a bounds)."""
PROBABILITY = (0.6, 0.95)
"""That the shortest piece and a sure one block: the rest is what moves, and mixed ranges."""
THICKNESS_M = 0.02
"""Size of the box across and upwards: a laser sees one line, at one height."""
HEIGHT_SIGMA_M = 0.5
"""Standard deviation of the unknown middle of what was seen at one height."""
END_SIGMA_M = 0.05
"""Of where a piece ends: about a beam spacing."""
RANGE_SIGMA_M = 0.01
"""Of where its line lies: range and pose error that all beams share."""
FOOTPRINT_STEP_M = 0.02


class LaserBoundDetector:
    """Bounds as line segments of the laser scan, at least 0.3 m long (paper §II.D.i, E_l)."""

    name = "laser-bounds"
    affordances: tuple[str, ...] = ("BlockAbility",)
    stage = 0

    def detect(self, view: View, earlier: Sequence[Detection]) -> Sequence[Detection]:
        """One detection per straight piece of the scan; none without a scan."""
        if view.scan is None:
            return ()
        T = view.T_map_laser
        return tuple(self._detection(s, T) for s in segments_of(view.scan))

    def _detection(self, segment: Segment, T_map_laser: Array) -> Detection:
        ends = transform_xy(T_map_laser, segment.ends_xy)
        length, height = segment.length_m, float(T_map_laser[2, 3])
        (ax, ay), (bx, by) = ends.tolist()
        span, x, y = ends[1] - ends[0], (ax + bx) / 2, (ay + by) / 2
        n = max(2, round(length / FOOTPRINT_STEP_M))
        return Detection(
            detector=self.name,
            affordances={"BlockAbility": _probability(length)},
            box=OrientedBox(
                (x, y, height),
                (length, THICKNESS_M, THICKNESS_M),
                math.atan2(by - ay, bx - ax),
            ),
            position_xyz=np.array([x, y, height]),
            covariance_xyz=_covariance(bx - ax, by - ay, segment),
            footprint_xy=ends[0] + np.arange(n)[:, None] * (span / (n - 1)),
            n_pixels=segment.n_beams,
            range_m=segment.range_m,
            segment_xy=ends,
            extent_known=False,
            measures={"length_m": length, "rms": segment.rms_m, "seen_at_height_m": height},
        )


def _probability(length_m: float) -> float:
    """Rises with length up to `SURE_LENGTH_M`."""
    least, most = PROBABILITY
    return least + (most - least) * min(1.0, length_m / SURE_LENGTH_M)


def _covariance(dx: float, dy: float, segment: Segment) -> Array:
    """(3, 3) m² of the segment's middle: loose along the wall and upwards, tight across."""
    length = math.hypot(dx, dy)
    ux, uy = dx / length, dy / length
    line = RANGE_SIGMA_M**2 + segment.rms_m**2 / segment.n_beams
    excess = END_SIGMA_M**2 - line
    xx, xy, yy = line + excess * ux * ux, excess * ux * uy, line + excess * uy * uy
    return np.array([[xx, xy, 0.0], [xy, yy, 0.0], [0.0, 0.0, HEIGHT_SIGMA_M**2]])
