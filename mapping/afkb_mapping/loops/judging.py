"""Whether a verified proposal is to be believed: odometry, other proposals, and the whole graph."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.loops.constellation import ANOTHER_M, ANOTHER_RAD
from afkb_mapping.loops.pose_graph import CONSISTENT, disagreement
from afkb_mapping.loops.proposals import Proposal
from afkb_mapping.loops.steps import pose_of
from afkb_mapping.loops.survey import Survey, apart

Array = NDArray[np.float64]


def judged(proposals: Iterable[Proposal], survey: Survey) -> list[Proposal]:
    """The proposals; those that odometry rules out, or that stand alone, rejected."""
    return unwitnessed([ruled_out(p, survey) for p in proposals], survey)


def ruled_out(proposal: Proposal, survey: Survey) -> Proposal:
    """The proposal, rejected where odometry rules it out (chi² gate)."""
    if proposal.constraint is None:
        return proposal
    a, b = proposal.earlier, proposal.later
    by_way = np.linalg.inv(survey.way.T[a]) @ survey.way.T[b]
    off = pose_of(np.linalg.inv(proposal.constraint.T_a_b) @ by_way)
    covariance = survey.way.covariance(a, b) + proposal.constraint.covariance
    chi2 = float(off @ np.linalg.solve(covariance, off))
    if chi2 > CONSISTENT:
        return proposal.rejected(f"odometry rules it out: chi² {chi2:.0f}, at most {CONSISTENT}")
    return proposal


def unwitnessed(proposals: Sequence[Proposal], survey: Survey) -> list[Proposal]:
    """The proposals; one that would move the robot to another place needs a second that agrees.

    Rooms that look alike are that far apart; one glance does not tell them.
    """
    found = []
    for proposal in proposals:
        off_m, off_rad = proposal.correction(survey.poses)
        if off_m > ANOTHER_M or off_rad > ANOTHER_RAD:
            others = (p for p in proposals if p.later != proposal.later)
            if not any(_agree(proposal, p, survey.poses) for p in others):
                proposal = proposal.rejected(
                    f"no second view bears out a correction of {off_m:.2f} m, {off_rad:.2f} rad"
                )
        found.append(proposal)
    return found


def _agree(first: Proposal, second: Proposal, poses: Sequence[Array]) -> bool:
    """Whether two proposals correct the way alike."""
    if first.constraint is None or second.constraint is None:
        return False
    T_first, T_second = (
        p.T_corrected(poses) @ np.linalg.inv(poses[p.later]) for p in (first, second)
    )
    at = poses[first.later]
    off_m, off_rad = apart(T_first @ at, T_second @ at)
    return off_m <= ANOTHER_M and off_rad <= ANOTHER_RAD


def contradicting(proposals: Sequence[Proposal], poses: Sequence[Array]) -> list[Proposal]:
    """The proposals, without those that the best poses contradict."""
    found = []
    for proposal in proposals:
        if proposal.constraint is not None:
            chi2 = disagreement(poses, proposal.loop)
            if chi2 > CONSISTENT:
                proposal = proposal.rejected(f"the other loops contradict it: chi² {chi2:.0f}")
        found.append(proposal)
    return found
