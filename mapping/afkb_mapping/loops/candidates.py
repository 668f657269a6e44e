"""Places seen again, by laser scans that fit and by things that stand as they stood."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from afkb.flow import LoopKind
from afkb_mapping.loops.constellation import recognised
from afkb_mapping.loops.landmarks import Landmarks, joined
from afkb_mapping.loops.proposals import Proposal
from afkb_mapping.loops.surroundings import surface_around
from afkb_mapping.loops.survey import AWAY_M, SEEN_FROM_M, Survey, apart
from afkb_mapping.loops.verification import verified

Array = NDArray[np.float64]

NEAR_M = 2.0
"""Scans from further apart than this, beside what the way is uncertain by, share little."""
VISITS = 2
"""Scans are matched with so many earlier visits of a place, the nearest."""


def scan_matches(survey: Survey, later: int) -> Iterator[Proposal]:
    """Laser scans of earlier visits that this one fits (paper §II.E)."""
    for earlier in _visits(survey, later):
        yield checked(survey, LoopKind.SCAN, earlier, later, survey.expected(earlier, later))


def _visits(survey: Survey, later: int) -> list[int]:
    """Stations of earlier visits near this one, one a visit, the nearest first."""
    here = survey.poses[later]
    if not survey.stations[later].has_laser:
        return []
    ranked = []
    for k in survey.again(later, NEAR_M).tolist():
        if survey.stations[k].has_laser:
            off_m, off_rad = apart(survey.poses[k], here)
            ranked.append((off_m + off_rad / np.pi, k))
    found: list[int] = []
    for _, k in sorted(ranked):
        if not any(abs(survey.way.metres[k] - survey.way.metres[j]) < AWAY_M for j in found):
            found.append(k)
    return found[:VISITS]


def checked(
    survey: Survey, kind: LoopKind, earlier: int, later: int, T_start: Array, weight: float = 0.0
) -> Proposal:
    """A proposal, verified by walls and free space from a start on; the start itself first."""
    stations, poses = survey.stations, survey.poses
    onto = surface_around(stations, poses, earlier)
    seen = surface_around(stations, poses, later, None if weight else (later,))
    # Surroundings are of several views, seen from elsewhere: no match of them is a laser's.
    by_laser = not weight and stations[earlier].has_laser and stations[later].has_laser
    verdict = verified(onto, stations[later], seen, T_start, by_laser)
    return Proposal(
        kind, earlier, later, weight or verdict.overlap, verdict.constraint, verdict.reason
    )


def constellations(survey: Survey, later: int) -> Iterator[Proposal]:
    """Static things seen around here that stand as things do that were seen before."""
    known, seen_by = _known_landmarks(survey, later)
    if not len(known):
        return
    view = survey.around(later)
    sigmas = survey.sigmas(int(seen_by.min()), later)
    found = recognised(view, known, survey.poses[later], sigmas)
    if found is None:
        return
    earlier = int(np.bincount(seen_by[found.pairs[:, 1]]).argmax())
    kind = LoopKind.CONSTELLATION
    if found.is_ambiguous:
        share = found.runner_up / found.weight
        reason = f"ambiguous: another place explains {share:.0%} of what is seen as well"
        yield Proposal(kind, earlier, later, found.weight, None, reason)
        return
    T_start = np.linalg.inv(survey.poses[earlier]) @ found.T_known_view
    yield checked(survey, kind, earlier, later, T_start, found.weight)


def _known_landmarks(survey: Survey, later: int) -> tuple[Landmarks, NDArray[np.intp]]:
    """Landmarks of earlier visits near here, map frame, each thing once, and who saw them."""
    near = [k for k in survey.again(later, SEEN_FROM_M).tolist() if survey.is_key(k)]
    parts = [survey.around(k).seen_from(survey.poses[k]) for k in near]
    if not parts:
        return survey.around(later)[np.empty(0, np.intp)], np.empty(0, np.intp)
    seen, by = joined(parts), np.repeat(near, [len(p) for p in parts])
    kept = seen.distinct()
    return seen[kept], by[kept]
