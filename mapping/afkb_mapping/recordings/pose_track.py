"""A frame's poses over time: recorded one by one, in any order, looked up at one moment."""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame

NS = 1_000_000_000


class Track:
    """Poses of a child frame in its parent over time: stamps (ns), metres, quaternions (x y z w).

    `static` holds at all times, the last one stated. 64 bytes a sample, so that hours of odometry
    stay small.
    """

    def __init__(self, static: bool = False) -> None:
        self.static = static
        self._new_stamps = array("q")
        self._new_values = array("d")
        self._stamps = np.empty(0, np.int64)
        self._values = np.empty((0, 7))

    def __len__(self) -> int:
        return len(self._new_stamps) + len(self._stamps)

    def add(self, stamp: int, xyz: tuple[float, ...], quat_xyzw: tuple[float, ...]) -> None:
        """Take in a pose; one that is not finite or has a zero quaternion counts as missing."""
        norm = math.sqrt(sum(q * q for q in quat_xyzw))
        if not (math.isfinite(norm) and norm > 1e-6 and all(map(math.isfinite, xyz))):
            return
        if self.static:
            del self._new_stamps[:], self._new_values[:]
        self._new_stamps.append(stamp)
        self._new_values.extend((*xyz, *(q / norm for q in quat_xyzw)))

    def at(self, stamp: int, max_dt: float, max_gap: float) -> NDArray[np.float64]:
        """T_parent_child (4, 4) at a stamp (ns).

        Interpolated between samples at most `max_gap` s apart, else the nearest within `max_dt` s;
        `BadFrame` where there is neither.
        """
        self._sort_in()
        stamps, values = self._stamps, self._values
        if self.static:
            return T_from_pose(values[-1])
        after = int(np.searchsorted(stamps, stamp))
        if after < len(stamps) and stamps[after] == stamp:
            return T_from_pose(values[after])
        inside = 0 < after < len(stamps)
        if inside and stamps[after] - stamps[after - 1] <= max_gap * NS:
            share = (stamp - stamps[after - 1]) / (stamps[after] - stamps[after - 1])
            return _between(values[after - 1], values[after], float(share))
        around = (max(after - 1, 0), min(after, len(stamps) - 1))
        near = min(around, key=lambda i: abs(int(stamps[i]) - stamp))
        gap = abs(int(stamps[near]) - stamp) / NS
        if gap > max_dt:
            raise BadFrame(f"no transform within {max_dt:g} s (nearest {gap:.3f} s away)")
        return T_from_pose(values[near])

    @property
    def span(self) -> tuple[int, int]:
        """First and last stamp, ns; of a track that has poses."""
        self._sort_in()
        return int(self._stamps[0]), int(self._stamps[-1])

    @property
    def stands_still(self) -> bool:
        """Whether there are several poses and all are at the same place."""
        self._sort_in()
        return len(self._stamps) > 1 and bool((self._values[:, :3] == self._values[0, :3]).all())

    def _sort_in(self) -> None:
        """Move what was added since the last look-up to where it belongs in time."""
        if not self._new_stamps:
            return
        stamps = np.concatenate([self._stamps, np.array(self._new_stamps, dtype=np.int64)])
        values = np.concatenate([self._values, np.array(self._new_values).reshape(-1, 7)])
        order = np.argsort(stamps, kind="stable")
        self._stamps, self._values = stamps[order], values[order]
        self._new_stamps, self._new_values = array("q"), array("d")


def _between(a: NDArray[np.float64], b: NDArray[np.float64], share: float) -> NDArray[np.float64]:
    from scipy.spatial.transform import Rotation, Slerp

    T = np.eye(4)
    T[:3, :3] = Slerp([0.0, 1.0], Rotation.from_quat([a[3:], b[3:]]))(share).as_matrix()
    T[:3, 3] = (1 - share) * a[:3] + share * b[:3]
    return T


def T_from_pose(value: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
    """Transform (4, 4) of a pose x, y, z (m), qx, qy, qz, qw."""
    from scipy.spatial.transform import Rotation

    T = np.eye(4)
    T[:3, :3] = Rotation.from_quat(value[3:]).as_matrix()
    T[:3, 3] = value[:3]
    return T
