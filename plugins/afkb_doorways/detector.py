"""Grounds pass-ability: a gap in a vertical plane that reaches the floor (doorways)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, OrientedBox, View
from afkb_doorways.evidence import NOTHING_SEEN, GapEvidence, evidence_of
from afkb_doorways.gaps import Beams, Gap, gaps_in
from afkb_doorways.settings import DoorwaySettings
from afkb_mapping.geometry import yaw_of
from afkb_mapping.panorama import Panorama, panorama_of
from afkb_mapping.sensor_noise import depth_sigma
from afkb_mapping.trapezoids import membership

Array = NDArray[np.float64]

JAMB_LENGTH_M = (0.1, 0.4)
"""A jamb as long as the second is a wall; as short as the first it is a leg or a post."""
UNKNOWN_HEIGHT = 0.6
"""P(wall | straight jamb whose height nobody saw): at shin height furniture looks the same."""
LEAST = 0.1
"""What is less likely is not worth telling."""
NOMINAL_HEIGHT_M = 2.0
"""Height of the box where no lintel was seen."""
THICKNESS_M = 0.1
FOOTPRINT_STEP_M = 0.02
JAMB_SIGMA_M = 0.03
"""Standard deviation of where a jamb ends: about a beam spacing at a few metres."""


class DoorwayDetector:
    """Passages, from the laser scan where there is one, else from depth alone (paper §II.D.i).

    Depth besides the scan says whether the jambs are walls, whether the passage is free at every
    height, and how high its lintel hangs. A wide gap lets one pass as well, but is no doorway: the
    ontology's trapezoids say how wide and how high.
    """

    name = "doorways"
    affordances: tuple[str, ...] = ("PassAbility",)
    stage = 0

    def __init__(self, settings: DoorwaySettings | None = None) -> None:
        self.settings = settings or DoorwaySettings()

    def detect(self, view: View, earlier: Sequence[Detection] = ()) -> list[Detection]:
        """Gaps between jambs, likeliest first; each edge is part of one of them."""
        panorama = panorama_of(view)
        beams = scan_beams(view) if view.scan is not None else panorama_beams(panorama)
        narrowest, _, _, widest = self.settings.width_m
        judged = []
        for gap in gaps_in(beams, narrowest, widest):
            plan = self._plan(gap)
            if plan < LEAST:
                continue
            seen = NOTHING_SEEN if panorama is None else evidence_of(gap, view, panorama)
            p = self._probability(plan, seen)
            if p >= LEAST:
                judged.append((p, gap, seen))
        judged.sort(key=lambda found: -found[0])
        return [
            self._detection(p, gap, seen, view, beams) for p, gap, seen in _one_per_edge(judged)
        ]

    def _plan(self, gap: Gap) -> float:
        """Probability of a passage by what it looks like from above."""
        p = membership(gap.width_m, self.settings.width_m) * math.sqrt(gap.square) * gap.deep
        least, sure = JAMB_LENGTH_M
        for length in gap.lengths_m:
            p *= min(1.0, max(0.0, (length - least) / (sure - least)))
        return p

    def _probability(self, plan: float, seen: GapEvidence) -> float:
        """The same with what depth says of it."""
        p = 0.97 * plan
        for tall in seen.tall:
            p *= UNKNOWN_HEIGHT if math.isnan(tall) else tall
        if not math.isnan(seen.open):
            p *= seen.open
        if not math.isnan(seen.lintel_m):
            p *= membership(seen.lintel_m, self.settings.height_m)
        return p

    def _detection(
        self, p: float, gap: Gap, seen: GapEvidence, view: View, beams: Beams
    ) -> Detection:
        along = (gap.jambs_xy[1] - gap.jambs_xy[0]) / gap.width_m
        x, y = gap.middle_xy
        range_m = float(np.linalg.norm(gap.middle_xy - beams.center_xy))
        height = NOMINAL_HEIGHT_M if math.isnan(seen.lintel_m) else seen.lintel_m
        sigma = JAMB_SIGMA_M + depth_sigma(range_m)
        steps = np.linspace(0, 1, max(2, round(gap.width_m / FOOTPRINT_STEP_M)))
        measures = {
            "width": gap.width_m,
            "plan": self._plan(gap),
            "jambs": float(sum(t > 0.5 for t in seen.tall)),
            "open": seen.open,
            "lintel_height": seen.lintel_m,
        }
        return Detection(
            detector=self.name,
            affordances={"PassAbility": p},
            box=OrientedBox(
                (float(x), float(y), height / 2),
                (THICKNESS_M, gap.width_m, height),
                math.atan2(-along[0], along[1]),
            ),
            position_xyz=np.array([x, y, height / 2]),
            covariance_xyz=np.diag([sigma**2, sigma**2, 0.25]),
            footprint_xy=gap.jambs_xy[0] + np.outer(steps, gap.jambs_xy[1] - gap.jambs_xy[0]),
            n_pixels=gap.n_beams,
            range_m=range_m,
            extent_known=not math.isnan(seen.lintel_m),
            measures={name: value for name, value in measures.items() if not math.isnan(value)},
        )


def scan_beams(view: View) -> Beams:
    """The beams of a placed view's laser scan, seen from above."""
    assert view.scan is not None
    T, hit = view.T_map_laser, view.scan.hit
    reach = np.where(hit, view.scan.ranges_m, 0.0).astype(np.float64)
    order = 1 if view.scan.angle_increment > 0 else -1
    bearings = view.scan.angles + yaw_of(T)
    return Beams(T[:2, 3], bearings[::order], reach[::order], hit[::order])


def panorama_beams(panorama: Panorama | None) -> Beams:
    """The same from depth alone: what stands in the way at any height, and free floor."""
    if panorama is None:
        return Beams(np.zeros(2), np.zeros(0), np.zeros(0), np.zeros(0, dtype=bool))
    solid = np.isfinite(panorama.obstacle_m)
    return Beams(panorama.center_xy, panorama.bearings, panorama.free_m, solid)


def _one_per_edge(
    judged: Sequence[tuple[float, Gap, GapEvidence]],
) -> Iterator[tuple[float, Gap, GapEvidence]]:
    """The likeliest first; none that shares an edge or its place with a likelier one."""
    kept: list[Gap] = []
    for p, gap, seen in judged:
        if all(_apart(gap, other) for other in kept):
            kept.append(gap)
            yield p, gap, seen


def _apart(gap: Gap, other: Gap) -> bool:
    jambs, others = gap.jambs_xy.tolist(), other.jambs_xy.tolist()
    same_edge = any(math.dist(a, b) < THICKNESS_M for a, b in zip(jambs, others, strict=True))
    off = math.dist(gap.middle_xy.tolist(), other.middle_xy.tolist())
    return not same_edge and off > max(gap.width_m, other.width_m) / 2
