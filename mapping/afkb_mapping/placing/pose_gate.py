"""Keeps one absurd pose from stretching the map over the horizon."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import View

GREATEST_SPEED_M_S = 10.0
"""No indoor robot, and no hand that holds a camera, is faster."""
GREATEST_STEP_M = 10.0
"""Recordings have gaps in which a robot drives on; within this, any step may be one."""
AGREEING_FRAMES = 3
"""So many frames in a row that agree on a new place are no glitch: the robot was carried there."""


class PoseGate:
    """Tells poses that a robot can have reached from glitches of its odometry."""

    def __init__(self) -> None:
        self._last: View | None = None
        self._doubted: list[View] = []

    def check(self, view: View) -> None:
        """Raise `BadFrame` where the base can't have come here from where it was last.

        A pose that `AGREEING_FRAMES` frames in a row agree on is believed.
        """
        if self._last is not None and _is_too_far(self._last, view):
            agrees = self._doubted and not _is_too_far(self._doubted[-1], view)
            self._doubted = [*self._doubted, view] if agrees else [view]
            if len(self._doubted) < AGREEING_FRAMES:
                step = np.linalg.norm(_position(view) - _position(self._last))
                raise BadFrame(
                    f"the pose lies {step:.3g} m from the last one, after "
                    f"{view.stamp - self._last.stamp:.3g} s: no robot is that fast"
                )
        self._last, self._doubted = view, []


def _is_too_far(before: View, after: View) -> bool:
    step = float(np.linalg.norm(_position(after) - _position(before)))
    return step > GREATEST_STEP_M + GREATEST_SPEED_M_S * abs(after.stamp - before.stamp)


def _position(view: View) -> NDArray[np.float64]:
    return view.T_odom_base[:3, 3]
