"""All that is known when loops are looked for, and which pairs of stations are worth a look."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.geometry import yaw_of
from afkb_mapping.loops.landmarks import Landmarks
from afkb_mapping.loops.stations import Station
from afkb_mapping.loops.surroundings import landmarks_around
from afkb_mapping.loops.way import Way

Array = NDArray[np.float64]

AWAY_M, AWAY_RAD = 5.0, 4 * np.pi
"""A place is seen *again* if the robot went this far, or turned twice around, in between."""
KEY_M, KEY_RAD = 1.0, 1.0
"""A place is looked for again wherever the robot went or turned this far since the last time."""
SEEN_FROM_M = 6.0
"""Things around stations within this distance may be seen from both."""


class Survey:
    """Stations, the way between them, and where they stand: `poses`, T_map_base (4, 4) each.

    `keys`: stations from which places are looked for again, the first of all among them.
    """

    def __init__(self, stations: Sequence[Station], way: Way, poses: Sequence[Array]) -> None:
        self.stations, self.way, self.poses = stations, way, poses
        self.keys = _keys(way)
        self._xy = np.array([T[:2, 3] for T in poses])
        self._keys = frozenset(self.keys)
        self._around: dict[int, Landmarks] = {}

    def around(self, k: int) -> Landmarks:
        """Landmarks seen from around a station, in its base frame; each thing once."""
        if k not in self._around:
            self._around[k] = landmarks_around(self.stations, self.poses, k)
        return self._around[k]

    def is_key(self, k: int) -> bool:
        """Whether places are looked for again from here."""
        return k in self._keys

    def is_away(self, earlier: int, later: int) -> bool:
        """Whether the robot has been away in between the first and the second."""
        return bool(earlier < later and self._away(later)[earlier])

    def again(self, later: int, within_m: float) -> NDArray[np.intp]:
        """Stations near this one (m) from which the robot has been away since, in order."""
        near = np.hypot(*(self._xy[:later] - self._xy[later]).T) <= within_m
        return np.flatnonzero(near & self._away(later))

    def _away(self, later: int) -> NDArray[np.bool_]:
        metres, turned = self.way.metres, self.way.turned
        gone: NDArray[np.bool_] = metres[later] - metres[:later] >= AWAY_M
        gone |= turned[later] - turned[:later] >= AWAY_RAD
        return gone

    def sigmas(self, earlier: int, later: int) -> Array:
        """(3,) how uncertain the later is as seen from the earlier: x, y (m), yaw (rad)."""
        found: Array = np.sqrt(np.diag(self.way.covariance(earlier, later)))
        return found

    def expected(self, earlier: int, later: int) -> Array:
        """(4, 4) the later as seen from the earlier, as far as is known."""
        T: Array = np.linalg.inv(self.poses[earlier]) @ self.poses[later]
        return T


def _keys(way: Way) -> list[int]:
    keys = [0]
    for k in range(1, len(way.metres)):
        gone, turned = way.metres[k] - way.metres[keys[-1]], way.turned[k] - way.turned[keys[-1]]
        if gone >= KEY_M or turned >= KEY_RAD:
            keys.append(k)
    return keys


def apart(T_a: Array, T_b: Array) -> tuple[float, float]:
    """Distance (m) and turn (rad) between two planar poses."""
    T = np.linalg.inv(T_a) @ T_b
    return float(np.hypot(T[0, 3], T[1, 3])), abs(yaw_of(T))
