"""Where in a map a later visit begins: its first views are located, with no idea of where."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations, islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import SourceError
from afkb.flow import View
from afkb_mapping.geometry import T_from_xy_yaw, inverse, planar, yaw_of
from afkb_mapping.localisation.localiser import Localiser
from afkb_mapping.localisation.questions import asked, localiser_of
from afkb_mapping.selection import Selection

Array = NDArray[np.float64]

TOGETHER = 3
"""So many views in a row are asked about as one; one alone may stare at a wall."""
FIRST_VIEWS = 30
"""A robot that can't say where it is after so many views is not in a place that it knows."""
AGREE_M, AGREE_RAD = 0.5, math.radians(15)
"""Two answers this near, by what odometry drifts over thirty views, are the same place."""


def T_map_source_of_visit(folder: Path, selection: Selection, T_level_source: Array) -> Array:
    """(4, 4) from a later recording's pose frame to the frame of a stored map.

    `T_level_source` (4, 4): from its pose frame to any level frame with z = 0 on the floor. Two
    questions that share no view must agree on it: a single answer is wrong now and then, and would
    make two homes of one. Raises `SourceError` where none agree: the robot is lost.
    """
    localiser, answers, views = localiser_of(folder), [], 0
    for together in islice(_together(selection), FIRST_VIEWS // TOGETHER):
        views += len(together)
        found = _answer(localiser, together, T_level_source)
        if found is not None:
            answers.append(found)
        agreed = _agreed(answers)
        if agreed is not None:
            return agreed
    if views <= TOGETHER and answers:
        return answers[0]
    raise SourceError(
        f"the recording's first {views} views can't be located in {folder}: another place, or too "
        "much has changed; map it on its own with --out, or begin elsewhere with --start"
    )


def _together(selection: Selection) -> Iterator[list[View]]:
    views = (frame for frame in selection.frames() if isinstance(frame, View))
    while together := list(islice(views, TOGETHER)):
        yield together


def _answer(localiser: Localiser, views: list[View], T_level_source: Array) -> Array | None:
    """T_map_source by where the last of some views was; None where that is not known."""
    found = localiser.locate(asked(views, T_level_source))
    if found.lost:
        return None
    T_level_base = T_level_source @ views[-1].T_odom_base
    T = T_from_xy_yaw(found.x, found.y, found.yaw) @ inverse(planar(T_level_base))
    return T @ T_level_source


def _agreed(answers: list[Array]) -> Array | None:
    """The first of two answers that are the same; the last answer is new."""
    for earlier, later in combinations(answers, 2):
        T = later @ np.linalg.inv(earlier)
        at = earlier[:2, 3]
        shift = np.linalg.norm(T[:2, :2] @ at + T[:2, 3] - at)
        if shift <= AGREE_M and abs(yaw_of(T)) <= AGREE_RAD:
            return earlier
    return None
