"""Closing loops: from all views of a run, corrected poses, and what was proposed and why not."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Closure, LoopProposal
from afkb.inference import Network
from afkb_mapping.geometry import inverse, yaw_of
from afkb_mapping.loops.candidates import constellations, scan_matches
from afkb_mapping.loops.judging import contradicting, judged
from afkb_mapping.loops.landmarks import Recogniser
from afkb_mapping.loops.pose_graph import CONSISTENT, disagreement, optimised
from afkb_mapping.loops.predicted import predictions_seen
from afkb_mapping.loops.proposals import Proposal, stated
from afkb_mapping.loops.shared_space import shared_spaces
from afkb_mapping.loops.stations import SeenView, Station, station_of
from afkb_mapping.loops.steps import matched_step, step_between
from afkb_mapping.loops.survey import Survey
from afkb_mapping.loops.way import Way

Array = NDArray[np.float64]

CORRECTION_M, CORRECTION_RAD = 0.03, 0.015
"""A loop that corrects less confirms the way: that is half a cell of the grid, at 2 m."""


@dataclass(frozen=True, slots=True, eq=False)
class ClosedLoops:
    """What came of closing loops.

    - `poses`: T_map_base (4, 4) of each view. `moved`: whether these are not as they were.
    - `proposals`: those that correct something, or were rejected. `confirmed`: how many others
      found the way right as it was.
    """

    poses: tuple[Array, ...]
    moved: bool
    proposals: tuple[LoopProposal, ...]
    confirmed: int


def close_loops(
    seen: Iterable[SeenView], network: Network, predicted: Sequence[Closure] = ()
) -> ClosedLoops:
    """Find places that were seen again, and correct the way by those that prove right.

    Each proposal is verified by walls and free space, held against odometry, and optimised with the
    others in a robust pose graph; one that fails keeps its reason (paper §II.D.ii, iii, §II.E).
    `predicted`: predictions that came true. The first view stays where it is. Poses that were given
    for a camera are no odometry, and are kept.
    """
    recogniser = Recogniser(network)
    return closed([station_of(s, recogniser) for s in seen], predicted)


def closed(stations: Sequence[Station], predicted: Sequence[Closure] = ()) -> ClosedLoops:
    """`close_loops` of stations."""
    before = [s.T_map_base for s in stations]
    if len(stations) < 2 or all(s.pose_is_given for s in stations):
        return ClosedLoops(tuple(s.T_placed for s in stations), False, (), 0)
    steps = [step_between(a, b) for a, b in pairwise(stations)]
    survey = Survey(stations, Way(stations[0].T_map_base, steps), before)
    proposals = judged(_proposed(survey, predicted), survey)
    after = before
    if any(_corrects(p, survey) for p in _verified(proposals)):
        after, proposals = _corrected(survey, proposals)
    told = [p for p in proposals if p.constraint is None or _corrects(p, survey)]
    moved = any(map(_moved, before, after))
    return ClosedLoops(
        tuple(_placed(stations, after)) if moved else tuple(s.T_placed for s in stations),
        moved,
        tuple(stated(p, survey) for p in told),
        len(proposals) - len(told),
    )


def _placed(stations: Sequence[Station], poses: Sequence[Array]) -> Iterator[Array]:
    """Whole poses T_map_base (4, 4) of planar ones: height, roll and pitch stay."""
    yield stations[0].T_placed
    for station, T in zip(stations[1:], poses[1:], strict=True):
        yield T @ inverse(station.T_map_base) @ station.T_placed


def _proposed(survey: Survey, predicted: Sequence[Closure]) -> Iterator[Proposal]:
    """Whatever says that a place is seen again, the surest kind of evidence first."""
    for later in survey.keys:
        matches = list(scan_matches(survey, later))
        yield from matches
        if not any(p.constraint is not None for p in matches):
            yield from constellations(survey, later)
    yield from predictions_seen(survey, predicted)
    yield from shared_spaces(survey)


def _corrected(survey: Survey, proposals: Sequence[Proposal]) -> tuple[list[Array], list[Proposal]]:
    """The poses that agree best with all, and the proposals that these bear out.

    Now that poses are to move, each step is made as sure as the scans at its ends can make it.
    """
    steps = [matched_step(a, b) for a, b in pairwise(survey.stations)]
    surer = Survey(survey.stations, Way(survey.poses[0], steps), survey.poses)
    proposals = judged(proposals, surer)
    poses = optimised(survey.poses, steps, [p.loop for p in _verified(proposals)])
    checked = contradicting(proposals, poses)
    if any(a is not b for a, b in zip(checked, proposals, strict=True)):
        poses = optimised(survey.poses, steps, [p.loop for p in _verified(checked)])
    return poses, checked


def _moved(before: Array, after: Array) -> bool:
    """Whether a pose moves by what matters: else what was mapped stays as it is."""
    T = inverse(before) @ after
    return bool(np.hypot(T[0, 3], T[1, 3]) > CORRECTION_M or abs(yaw_of(T)) > CORRECTION_RAD)


def _verified(proposals: Sequence[Proposal]) -> list[Proposal]:
    return [p for p in proposals if p.constraint is not None]


def _corrects(proposal: Proposal, survey: Survey) -> bool:
    """Whether it moves the robot by what matters, and by more than it may err itself."""
    off_m, off_rad = proposal.correction(survey.poses)
    matters = off_m > CORRECTION_M or off_rad > CORRECTION_RAD
    return matters and disagreement(survey.poses, proposal.loop) > CONSISTENT
