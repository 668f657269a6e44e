"""Views of one place from different sides that share no thing, but the same affordances.

Paper §II.D.iii: such views "can be mapped to the same location or topological space", as a last
resort. They say nothing of how the views lie, so they correct nothing: they are proposed.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from afkb.flow import LoopKind
from afkb_mapping.geometry import wrap_angle, yaw_of
from afkb_mapping.loops.constellation import pair_weights
from afkb_mapping.loops.landmarks import Landmarks
from afkb_mapping.loops.proposals import Proposal
from afkb_mapping.loops.survey import SEEN_FROM_M, Survey

Array = NDArray[np.float64]

ALIKE = 0.9
"""Cosine between what two views afford, from which they afford the same."""
LEAST_THINGS = 2
"""One thing makes no space."""
ONE_SPACE_M = 2.0
"""Things of one space stand about as near to each other as people sit together."""
OTHER_SIDE_RAD = np.pi / 2
LOWEST_WEIGHT = 0.65
"""The paper's start value of a co-occurrence, below that of duals and observations."""
SAME_PLACE_M = 0.5
"""Sights of one thing lie no further apart, as well as the robot knows where it was."""
VISIT = 8
"""Stations fewer than this apart belong to one visit: they see the same."""
ONE_SPACE = "one space by what it affords, seen from two sides; shares no thing: corrects nothing"


def shared_spaces(survey: Survey) -> Iterator[Proposal]:
    """Pairs of visits that see one space from different sides, each pair of visits once."""
    told: list[tuple[int, int]] = []
    for later in survey.keys:
        for earlier in survey.again(later, SEEN_FROM_M).tolist():
            if not survey.is_key(earlier) or any(
                abs(earlier - a) < VISIT and abs(later - b) < VISIT for a, b in told
            ):
                continue
            if _is_one_space(survey, earlier, later):
                told.append((earlier, later))
                weight = LOWEST_WEIGHT * alike(survey.around(earlier), survey.around(later))
                yield Proposal(LoopKind.SHARED_SPACE, earlier, later, weight, None, ONE_SPACE)


def _is_one_space(survey: Survey, earlier: int, later: int) -> bool:
    T_a, T_b = survey.poses[earlier], survey.poses[later]
    if abs(wrap_angle(yaw_of(T_a) - yaw_of(T_b))) < OTHER_SIDE_RAD:
        return False
    a, b = survey.around(earlier).seen_from(T_a), survey.around(later).seen_from(T_b)
    if min(len(a), len(b)) < LEAST_THINGS:
        return False
    if np.hypot(*(a.xy.mean(axis=0) - b.xy.mean(axis=0))) > ONE_SPACE_M:
        return False
    return alike(a, b) >= ALIKE and not _share(a, b)


def alike(a: Landmarks, b: Landmarks) -> float:
    """Cosine between what two sets of things afford in all, each thing by its weight."""
    first, second = a.weight @ a.affords, b.weight @ b.affords
    length = float(np.linalg.norm(first) * np.linalg.norm(second))
    return float(first @ second) / length if length else 0.0


def _share(a: Landmarks, b: Landmarks) -> bool:
    """Whether any thing is in both, in one frame."""
    off = np.hypot(*(a.xy[:, None] - b.xy[None]).transpose(2, 0, 1))
    return bool((pair_weights(a, b, off <= SAME_PLACE_M) > 0).any())
