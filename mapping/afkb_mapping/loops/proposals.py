"""Who says that a place is seen again, and what came of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from afkb.flow import LoopKind, LoopProposal
from afkb_mapping.loops.pose_graph import Loop
from afkb_mapping.loops.steps import Constraint, pose_of
from afkb_mapping.loops.survey import Survey, apart

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Proposal:
    """Stations `earlier` and `later` (indexes) may be in one place.

    `constraint`: the later as seen from the earlier, where geometry bears it out, else None and
    the `reason` why not. `weight`: the evidence, as its kind counts it.
    """

    kind: LoopKind
    earlier: int
    later: int
    weight: float
    constraint: Constraint | None
    reason: str = ""

    @property
    def loop(self) -> Loop:
        """The constraint for the pose graph."""
        assert self.constraint is not None
        return Loop(self.earlier, self.later, self.constraint)

    def rejected(self, reason: str) -> Proposal:
        """The same, found to be wrong."""
        return replace(self, constraint=None, reason=reason)

    def T_corrected(self, poses: Sequence[Array]) -> Array:
        """(4, 4) where the later station stands if this is right, and the earlier one too."""
        assert self.constraint is not None
        T: Array = poses[self.earlier] @ self.constraint.T_a_b
        return T

    def correction(self, poses: Sequence[Array]) -> tuple[float, float]:
        """By how much (m, rad) it moves the later station; 0 where it was rejected."""
        if self.constraint is None:
            return 0.0, 0.0
        return apart(poses[self.later], self.T_corrected(poses))


def stated(proposal: Proposal, survey: Survey) -> LoopProposal:
    """The proposal as the map states it."""
    earlier, later = survey.stations[proposal.earlier], survey.stations[proposal.later]
    found = LoopProposal(
        kind=proposal.kind,
        view=later.index,
        earlier_view=earlier.index,
        stamp=later.stamp,
        earlier_stamp=earlier.stamp,
        weight=proposal.weight,
        accepted=False,
        reason=proposal.reason,
    )
    if proposal.constraint is None:
        return found
    off_m, off_rad = proposal.correction(survey.poses)
    x, y, yaw = pose_of(proposal.constraint.T_a_b).tolist()
    return replace(
        found,
        accepted=True,
        reason=VERIFIED,
        corrected_m=off_m,
        corrected_rad=off_rad,
        relative=(x, y, yaw),
    )


VERIFIED = "walls, free space, odometry and the other loops bear it out"
