"""One pass over a log: where its scan lines are, and which odometry stands at each."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb_carmen.lines import Pose, compose, invert, parse_odometry, poses_of, tag_of
from afkb_mapping.geometry import T_from_xy_yaw

SCAN_TAGS = (b"FLASER", b"ROBOTLASER1")
# A laser sits on its robot: poses that differ by more, or not always alike, say something else.
_MOUNT_MAX_M = 2.0
_MOUNT_SPREAD = 0.02
_SAME_MOMENT_S = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class LogIndex:
    """Where the scan lines are, in order of their stamps, and what takes the whole log to know.

    - `offsets`, `numbers`: (N,) byte offset and line number, from 1.
    - `chained_xyt`: (N, 3) pose at each scan from the steps of ODOM lines, m and rad.
    - `T_base_laser`: (4, 4) the laser's place on the robot, m.
    """

    offsets: NDArray[np.int64]
    numbers: NDArray[np.int64]
    chained_xyt: NDArray[np.float64]
    T_base_laser: NDArray[np.float64]

    def T_chained(self, index: int) -> NDArray[np.float64]:
        """Pose (4, 4) of the base at a scan, from ODOM lines alone."""
        return T_from_xy_yaw(*self.chained_xyt[index].tolist())


def build_index(path: Path, tag: bytes) -> LogIndex:
    """Read the log once; only a few numbers a scan are kept."""
    found, stamps, chained = array("q"), array("d"), array("d")
    mount, chain = _Mount(), _Chain()
    for offset, number, line in lines(path):
        this = tag_of(line)
        if this == tag:
            poses = poses_of(line)
            if poses is not None:
                mount.add(poses[0], poses[1])
                chain.scan(poses[1], poses[2])
            found.extend((offset, number))
            stamps.append(_stamp(poses, stamps))
            chained.extend(chain.pose)
        elif this == b"ODOM":
            chain.odometry(line)
    # Logs are written by several processes: neighbouring lines may be out of order.
    order = np.argsort(np.array(stamps), kind="stable")
    places = np.array(found, dtype=np.int64).reshape(-1, 2)[order]
    chained_xyt = np.array(chained).reshape(-1, 3)[order]
    return LogIndex(places[:, 0], places[:, 1], chained_xyt, mount.T_base_laser())


def _stamp(poses: tuple[Pose, Pose, float] | None, earlier: array[float]) -> float:
    """A scan line's stamp; a bad line keeps its place behind the line before it."""
    if poses is not None and math.isfinite(poses[2]):
        return poses[2]
    return earlier[-1] if earlier else -math.inf


def scan_tag(path: Path) -> bytes | None:
    """The tag of the scans to read: FLASER if the log has any, for they repeat the others."""
    best, second = SCAN_TAGS
    found = None
    for _, _, line in lines(path):
        tag = tag_of(line)
        if tag == best:
            return best
        found = second if tag == second else found
    return found


def lines(path: Path) -> Iterator[tuple[int, int, bytes]]:
    """Byte offset, number (from 1) and bytes of every line."""
    with path.open("rb") as file:
        offset = 0
        for number, line in enumerate(file, 1):
            yield offset, number, line
            offset += len(line)


class _Mount:
    """Where the laser sits on the robot, if the two poses of the scan lines tell."""

    def __init__(self) -> None:
        self._low: tuple[float, ...] = (math.inf,) * 3
        self._high: tuple[float, ...] = (-math.inf,) * 3

    def add(self, laser: Pose, robot: Pose) -> None:
        at = compose(invert(robot), laser)
        if all(map(math.isfinite, at)):
            self._low = tuple(map(min, self._low, at))
            self._high = tuple(map(max, self._high, at))

    def T_base_laser(self) -> NDArray[np.float64]:
        """Their constant difference; where it is none (corrected poses), the laser is the base."""
        spread = [high - low for low, high in zip(self._low, self._high, strict=True)]
        x, y, theta = ((a + b) / 2 for a, b in zip(self._low, self._high, strict=True))
        if not max(spread) < _MOUNT_SPREAD or math.hypot(x, y) > _MOUNT_MAX_M:
            return np.eye(4)
        return T_from_xy_yaw(round(x, 6), round(y, 6), round(theta, 6))


class _Chain:
    """Raw odometry: the steps between ODOM lines, one after the other.

    Some logs were written by a mapper that sets the odometry to its own estimate at each scan: the
    scan then has the last ODOM line's stamp and another pose. Such a jump is no motion.
    """

    def __init__(self) -> None:
        self.pose = Pose(0.0, 0.0, 0.0)
        self._last: tuple[Pose, float] | None = None

    def odometry(self, line: bytes) -> None:
        try:
            read = parse_odometry(line)
        except BadFrame:
            return  # ODOM poses are absolute: the next line makes up for the one that is cut short
        self._take(read.robot, read.stamp)

    def scan(self, robot: Pose, stamp: float) -> None:
        jump = self._last is not None and abs(self._last[1] - stamp) < _SAME_MOMENT_S
        self._take(robot, stamp, moved=not jump)

    def _take(self, robot: Pose, stamp: float, moved: bool = True) -> None:
        if not all(map(math.isfinite, robot)):
            return
        if moved:
            before = self._last[0] if self._last is not None else Pose(0.0, 0.0, 0.0)
            self.pose = compose(self.pose, compose(invert(before), robot))
        self._last = (robot, stamp)
