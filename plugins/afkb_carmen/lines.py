"""CARMEN's log lines, word by word, as its logger writes them.

- `FLASER n r₁ … rₙ x y theta odom_x odom_y odom_theta ipc_stamp host logger_stamp`
- `ROBOTLASER1 type start fov step max_range accuracy remission_mode n r₁ … rₙ m e₁ … eₘ
  laser_x laser_y laser_theta x y theta tv rv forward side turn ipc_stamp host logger_stamp`
- `ODOM x y theta tv rv acceleration ipc_stamp host logger_stamp`
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from afkb.errors import BadFrame
from afkb.flow import LaserScan

_FLASER_REST = 9
_ROBOTLASER_HEAD = 8
_ROBOTLASER_REST = 14
_RANGE_MIN_M = 0.02
_SICK_MAX_M = 80.0
# SICK LMS 2xx report errors ("no return", "dazzled" …) as 8183 … 8191, in cm or in mm.
_SICK_ERRORS_MM = (8.183, 8.1915)


class Pose(NamedTuple):
    """Planar pose: m, m, rad."""

    x: float
    y: float
    theta: float


def compose(a: Pose, b: Pose) -> Pose:
    """Pose `b`, given in frame `a`, in the frame that `a` is given in."""
    c, s = math.cos(a.theta), math.sin(a.theta)
    theta = math.remainder(a.theta + b.theta, 2 * math.pi)
    return Pose(a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, theta)


def invert(a: Pose) -> Pose:
    """The frame that `a` is given in, as a pose in `a`."""
    c, s = math.cos(a.theta), math.sin(a.theta)
    return Pose(-c * a.x - s * a.y, s * a.x - c * a.y, -a.theta)


@dataclass(frozen=True, slots=True, eq=False)
class ScanLine:
    """One scan: what was measured, where the log says the laser and the robot were, when (s)."""

    scan: LaserScan
    laser: Pose
    robot: Pose
    stamp: float


@dataclass(frozen=True, slots=True)
class OdometryLine:
    """One odometry reading and its stamp (s)."""

    robot: Pose
    stamp: float


def tag_of(line: bytes) -> bytes:
    """The word that says what a line is; empty for an empty line."""
    return b"".join(line.split(None, 1)[:1])


def parse_scan(line: bytes, fov_rad: float, max_range_m: float) -> ScanLine:
    """A scan line; `BadFrame` says where it is cut short or no number.

    `fov_rad` and `max_range_m` are for FLASER, which does not state them.
    """
    words = _words(line)
    if words[0] == "ROBOTLASER1":
        return _parse_robotlaser(words)
    return _parse_flaser(words, fov_rad, max_range_m)


def _parse_flaser(words: list[str], fov_rad: float, max_range_m: float) -> ScanLine:
    n = _flaser_size(words)
    scan = LaserScan(
        ranges_m=without_errors(_numbers(words[2 : 2 + n]), max_range_m),
        angle_min=-fov_rad / 2,
        angle_increment=angle_step(n, fov_rad),
        range_min_m=_RANGE_MIN_M,
        range_max_m=max_range_m,
    )
    return ScanLine(scan, *_flaser_poses(words))


def _parse_robotlaser(words: list[str]) -> ScanLine:
    n = _robotlaser_size(words)
    start, _, step, max_range_m = _numbers(words[2:6]).tolist()
    ranges = _numbers(words[_ROBOTLASER_HEAD + 1 : _ROBOTLASER_HEAD + 1 + n])
    scan = LaserScan(
        ranges_m=without_errors(ranges, max_range_m),
        angle_min=start,
        angle_increment=step,
        range_min_m=_RANGE_MIN_M,
        range_max_m=max_range_m,
    )
    return ScanLine(scan, *_robotlaser_poses(words))


def poses_of(line: bytes) -> tuple[Pose, Pose, float] | None:
    """Laser pose, robot pose and stamp of a scan line without its ranges; None where it is bad.

    An index reads these of every line; the frame's own parse says later what is bad about it.
    """
    try:
        words = _words(line)
        if words[0] == "ROBOTLASER1":
            _robotlaser_size(words)
            return _robotlaser_poses(words)
        _flaser_size(words)
        return _flaser_poses(words)
    except BadFrame:
        return None


def _flaser_size(words: list[str]) -> int:
    """Number of readings of a FLASER that has all its words."""
    n = _count(words, 1)
    _expect(words, 2 + n + _FLASER_REST, n)
    return n


def _flaser_poses(words: list[str]) -> tuple[Pose, Pose, float]:
    tail = _numbers(words[-9:-2]).tolist()
    return Pose(*tail[:3]), Pose(*tail[3:6]), tail[6]


def _robotlaser_size(words: list[str]) -> int:
    """Number of readings of a ROBOTLASER1 that has all its words, remissions included."""
    n = _count(words, _ROBOTLASER_HEAD)
    m_at = _ROBOTLASER_HEAD + 1 + n
    m = _count(words, m_at) if len(words) > m_at else 0
    _expect(words, m_at + 1 + m + _ROBOTLASER_REST, n)
    return n


def _robotlaser_poses(words: list[str]) -> tuple[Pose, Pose, float]:
    tail = _numbers([*words[-14:-8], words[-3]]).tolist()
    return Pose(*tail[:3]), Pose(*tail[3:6]), tail[6]


def parse_odometry(line: bytes) -> OdometryLine:
    """An ODOM line, or `BadFrame`."""
    words = _words(line)
    if len(words) < 8:
        raise BadFrame(f"ODOM of {len(words)} words is cut short, it has 10")
    numbers = _numbers(words[1:8])
    return OdometryLine(Pose(*numbers[:3].tolist()), float(numbers[6]))


def angle_step(n: int, fov_rad: float) -> float:
    """Angle between beams: 180 and 181 beams over 180° are both one degree apart.

    An odd number has a beam at either end, an even one lacks the last.
    """
    return fov_rad / (n - 1 if n % 2 and n > 1 else max(n, 1))


def without_errors(ranges_m: NDArray[np.float64], max_range_m: float) -> NDArray[np.float32]:
    """Ranges (N,) float32 m, inf where the laser says that nothing came back."""
    low, high = _SICK_ERRORS_MM
    with np.errstate(invalid="ignore"):
        failed = (ranges_m >= max_range_m) | ((ranges_m >= low) & (ranges_m <= high))
    return np.where(failed, np.inf, ranges_m).astype(np.float32)


def _words(line: bytes) -> list[str]:
    words = line.decode("ascii", "replace").split()
    if not words:
        raise BadFrame("empty line")
    return words


def _count(words: list[str], at: int) -> int:
    try:
        n = int(words[at])
    except (IndexError, ValueError) as error:
        raise BadFrame(f"{words[0]}: word {at} is to be the number of readings") from error
    if not 0 <= n <= 100_000:
        raise BadFrame(f"{words[0]}: {n} readings")
    return n


def _expect(words: list[str], expected: int, n: int) -> None:
    if len(words) != expected:
        fault = "is cut short" if len(words) < expected else "is too long"
        raise BadFrame(f"{words[0]} {fault}: {len(words)} words, {n} readings make {expected}")


def _numbers(words: list[str]) -> NDArray[np.float64]:
    try:
        return np.array(words, dtype=np.float64)
    except ValueError as error:
        bad = next((w for w in words if not _is_number(w)), "?")
        raise BadFrame(f"{bad[:20]!r} is not a number") from error


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
