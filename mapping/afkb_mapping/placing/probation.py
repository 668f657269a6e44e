"""A robot that was found again by its camera is on probation until more looks show that it was."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.placing.held_views import is_another_look

Array = NDArray[np.float64]

CONFIRMING_LOOKS = 3
"""So many looks, each from odometry's place and on its own, must find the map as it was before:
rooms look alike, but their neighbours seldom do too."""
PATIENCE = 8
"""After so many looks that don't, it was a place that only looked like the one it was taken for."""


@dataclass(slots=True, eq=False)
class Probation:
    """How it stands. `T_odom_base` (4, 4): odometry at the last look.

    `metres`, `degrees`: how far from odometry's place the robot was found.
    """

    T_odom_base: Array
    metres: float
    degrees: float
    confirmed: int = 0
    unclear: int = 0

    def is_news(self, T_odom_base: Array) -> bool:
        """Whether a view from there shows something else than the last look."""
        return is_another_look(self.T_odom_base, T_odom_base)

    def count(self, T_odom_base: Array, confirmed: bool) -> None:
        """One more view; one that shows nothing else than the last makes nothing surer."""
        if not self.is_news(T_odom_base):
            return
        self.T_odom_base = T_odom_base
        self.confirmed += confirmed
        self.unclear += not confirmed

    @property
    def is_passed(self) -> bool:
        """Whether enough looks have confirmed it."""
        return self.confirmed >= CONFIRMING_LOOKS

    @property
    def is_failed(self) -> bool:
        """Whether too many looks have told nothing."""
        return self.unclear >= PATIENCE
