"""How the frames of two maps lie to each other: one continues the other, or it is located in it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import MapError
from afkb.flow import View
from afkb_mapping.geometry import T_from_xy_yaw, inverse, planar, yaw_of
from afkb_mapping.localisation.localiser import Localiser
from afkb_mapping.localisation.questions import asked, localiser_of
from afkb_mapping.memory.memory import Memory
from afkb_mapping.memory.passed import RememberedViews

Array = NDArray[np.float64]

QUESTIONS, TOGETHER = 12, 3
"""At most so many times so many views in a row are located, spread over the whole visit."""
AGREE_M, AGREE_RAD = 0.4, math.radians(8)
"""Answers this near to each other are of one alignment: a map bends by less."""
LEAST_AGREEING, ENOUGH_AGREEING = 2, 4
"""Answers that agree: one is off by two cells of the map at most, and the mean of four by one."""


def is_continued_by(first: Memory, second: Memory) -> bool:
    """Whether the second map is an update of the first one: it begins with the same visits."""
    mine, others = ([v.as_json() for v in m.visits] for m in (first, second))
    return len(mine) < len(others) and others[: len(mine)] == mine


def T_first_second(folder: Path, other: Path, memory: Memory) -> Array:
    """(4, 4), planar: from the frame of the map in `other`, of which `memory` is, to `folder`'s.

    Its views are located in the first map, a few at a time; at least `LEAST_AGREEING` answers have
    to agree, as one may be wrong. Raises `MapError` where they don't: other places, other maps.
    """
    localiser, views = localiser_of(folder), memory.settled_views
    for sense in (_laser_alone, _by_map):
        located = _located(localiser, views, sense)
        if len(located) >= min(LEAST_AGREEING, len(views)):
            return _fitted(*zip(*located, strict=True))
    raise MapError(
        f"{other} can't be located in {folder}: another place, or too much of it has changed; "
        "--transform X,Y,YAW says where its origin lies in the first one's frame"
    )


def _located(
    localiser: Localiser, views: RememberedViews, sense: Callable[[View], View | None]
) -> list[tuple[Array, Array]]:
    """Answers that agree, (4, 4) each, and where in their own map they were asked, (2,)."""
    answers: list[Array] = []
    at: list[Array] = []
    agreeing: list[int] = []
    for start in _spread(max(len(views) - TOGETHER, 0) + 1):
        few = [sense(views[i].view) for i in range(start, min(start + TOGETHER, len(views)))]
        together = [view for view in few if view is not None]
        if not together:
            continue
        found = localiser.locate(asked(together, np.eye(4)))
        if found.lost:
            continue
        T = together[-1].T_odom_base
        answers.append(T_from_xy_yaw(found.x, found.y, found.yaw) @ inverse(planar(T)))
        at.append(T[:2, 3])
        agreeing = _most_agreeing(answers, at)
        if len(agreeing) == ENOUGH_AGREEING:
            break
    return [(answers[i], at[i]) for i in agreeing]


def _spread(count: int) -> list[int]:
    """At most `QUESTIONS` of so many numbers from 0, those that lie far apart first."""
    evenly = np.unique(np.linspace(0, count - 1, min(QUESTIONS, count)).astype(int)).tolist()
    return [n for first in range(4) for n in evenly[first::4]]


def _by_map(view: View) -> View:
    """The view with its pose in the map in place of its odometry."""
    assert view.T_map_base is not None
    return replace(view, T_odom_base=view.T_map_base)


def _laser_alone(view: View) -> View | None:
    """The same without depth: what a camera expects all over a map takes seconds to work out."""
    return None if view.scan is None else replace(_by_map(view), depth_m=None, camera=None)


def _most_agreeing(answers: Sequence[Array], at: Sequence[Array]) -> list[int]:
    best: list[int] = []
    for T in answers:
        agreeing = [
            i
            for i, (other, xy) in enumerate(zip(answers, at, strict=True))
            if np.linalg.norm(_moved(T, xy) - _moved(other, xy)) <= AGREE_M
            and abs(yaw_of(T @ np.linalg.inv(other))) <= AGREE_RAD
        ]
        best = max(best, agreeing, key=len)
    return best


def _fitted(answers: Sequence[Array], at: Sequence[Array]) -> Array:
    """The rigid motion that puts each view nearest to where it was located (least squares)."""
    source, target = (
        np.array(at),
        np.array([_moved(T, xy) for T, xy in zip(answers, at, strict=True)]),
    )
    turns = [yaw_of(T) for T in answers]
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    # Each answer's own heading counts as much as two points a metre from the middle would.
    cross = float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()) + float(np.sin(turns).sum())
    dot = float((a * b).sum()) + float(np.cos(turns).sum())
    T = T_from_xy_yaw(0.0, 0.0, math.atan2(cross, dot))
    T[:2, 3] = target.mean(axis=0) - T[:2, :2] @ source.mean(axis=0)
    return T


def _moved(T: Array, xy: Array) -> Array:
    moved: Array = T[:2, :2] @ xy + T[:2, 3]
    return moved
