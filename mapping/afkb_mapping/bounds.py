"""Bounds of the map: wall segments of many views, merged into one straight piece per wall side.

Each segment has a covariance: of its line's offset, and by its length of its direction. Two are one
wall if these allow it, and the better known one counts for more.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Bound, Detection
from afkb_mapping.bound_kernels import GAP_M, OFFSET_M, best_fit
from afkb_mapping.box_index import BoxIndex

Array = NDArray[np.float64]

POSE_SIGMA = (0.02, math.radians(1.0))
"""Standard deviations, m and rad, by which a view's pose moves and turns all of its segments."""
UNSTATED_SIGMA_M = 0.02
"""Of the offset of a segment that says nothing of it."""
WALL_M = 1.0


@dataclass(slots=True, eq=False)
class _Wall:
    """Evidence for one wall: moments of all its segments, from which its line is fitted.

    `mass`: summed lengths over the variances of their offsets, 1/m. `first`: (2,), `second`: (2, 2)
    moments with these weights. `information`: (2,) summed inverse variances of offset (1/m²) and
    direction (1/rad²). `seen`: first and last, s.
    """

    ends: Array
    mass: float
    first: Array
    second: Array
    information: Array
    observations: int
    detectors: set[str]
    seen: tuple[float, float]

    @classmethod
    def of(cls, segment: Array, sigma_m: float, detector: str, stamp: float) -> _Wall:
        length = float(np.linalg.norm(segment[1] - segment[0]))
        middle, half = segment.mean(axis=0), (segment[1] - segment[0]) / 2
        spread = np.outer(middle, middle) + np.outer(half, half) / 3
        mass = length / (sigma_m**2 + POSE_SIGMA[0] ** 2)
        turn_sigma = math.sqrt(12) * sigma_m / length
        information = np.array([sigma_m, turn_sigma]) ** -2
        return cls(
            segment.copy(),
            mass,
            mass * middle,
            mass * spread,
            information,
            1,
            {detector},
            (stamp, stamp),
        )

    @property
    def sigmas(self) -> tuple[float, float]:
        """Standard deviations of its line's offset (m) and direction (rad)."""
        offset, turn = (
            math.sqrt(1 / known + sigma * sigma / self.observations)
            for known, sigma in zip(self.information.tolist(), POSE_SIGMA, strict=True)
        )
        return offset, turn

    def absorb(self, other: _Wall) -> None:
        """Take over another wall's evidence; the line is fitted anew, the ends reach as far."""
        self.mass += other.mass
        self.first = self.first + other.first
        self.second = self.second + other.second
        self.information = self.information + other.information
        self.observations += other.observations
        self.detectors |= other.detectors
        self.seen = min(self.seen[0], other.seen[0]), max(self.seen[1], other.seen[1])
        middle = self.first / self.mass
        _, axes = np.linalg.eigh(self.second / self.mass - np.outer(middle, middle))
        along = axes[:, 1] * np.sign(axes[:, 1] @ (self.ends[1] - self.ends[0]))
        reach = (np.concatenate([self.ends, other.ends]) - middle) @ along
        self.ends = middle + np.outer([reach.min(), reach.max()], along)


class BoundMerger:
    """Collects bounds as they are detected; collinear ones that touch become one."""

    def __init__(self) -> None:
        self._walls: list[_Wall] = []
        self._ends = np.zeros((64, 2, 2))
        self._variances = np.zeros((64, 2))
        self._rows: dict[_Wall, int] = {}
        self._boxes: BoxIndex[_Wall] = BoxIndex()
        self._changed: list[tuple[Array, Array]] = []

    def add(self, detection: Detection, place: str | None = None, stamp: float = 0.0) -> None:
        """Take in one bound detected at `stamp`, s; `place`, the robot's, is for the caller's log.

        Raises `ValueError` for a detection without a segment.
        """
        if detection.segment_xy is None:
            raise ValueError(f"{detection.detector}: a bound needs segment_xy")
        sigma_m = across_sigma(detection.segment_xy, detection.covariance_xyz)
        self.add_segment(detection.segment_xy, detection.detector, sigma_m, stamp)

    def add_segment(
        self,
        segment_xy: Array,
        detector: str,
        sigma_m: float = UNSTATED_SIGMA_M,
        stamp: float = 0.0,
    ) -> None:
        """Take in one segment (2, 2), m, map frame, whose line is known to `sigma_m`."""
        segment = np.asarray(segment_xy, dtype=np.float64)
        if np.linalg.norm(segment[1] - segment[0]) < 1e-6:
            return
        wall = _Wall.of(segment, sigma_m, detector, stamp)
        # What the wall grew by may close the gap to the next: hence until nothing fits any more.
        while (index := self._match(wall)) is not None:
            known = self._remove(index)
            known.absorb(wall)
            wall = known
        self._append(wall)

    def _append(self, wall: _Wall) -> None:
        if len(self._walls) == len(self._ends):
            self._ends = np.concatenate([self._ends, np.zeros_like(self._ends)])
            self._variances = np.concatenate([self._variances, np.zeros_like(self._variances)])
        self._ends[len(self._walls)] = wall.ends
        self._variances[len(self._walls)] = np.square(wall.sigmas)
        self._rows[wall] = len(self._walls)
        self._walls.append(wall)
        box = wall.ends.min(axis=0), wall.ends.max(axis=0)
        self._boxes.put(wall, *box)
        self._changed.append(box)

    def changed(self) -> list[tuple[Array, Array]]:
        """Corners (2,), m, of the boxes around walls that are new or moved since it was asked."""
        changed, self._changed = self._changed, []
        return changed

    def _remove(self, index: int) -> _Wall:
        """Take a wall out; the last one takes its row."""
        wall, last = self._walls[index], self._walls.pop()
        self._boxes.remove(wall)
        del self._rows[wall]
        if last is not wall:
            self._rows[last] = index
            self._walls[index], self._ends[index] = last, last.ends
            self._variances[index] = self._variances[len(self._walls)]
        return wall

    def _match(self, segment: _Wall) -> int | None:
        """Index of the wall that a segment continues or repeats, the one it fits best."""
        # Walls further away than a gap along and an offset across the line are no match.
        near = self._near(segment.ends, GAP_M + OFFSET_M)
        best = best_fit(
            self._ends[near], self._variances[near], segment.ends, np.square(segment.sigmas)
        )
        return int(near[best]) if best >= 0 else None

    def _near(self, points_xy: Array, reach_m: float = 0.0) -> NDArray[np.intp]:
        """Rows of the walls that may come within reach of the box around points (N, 2), m."""
        low, high = points_xy.min(axis=0) - reach_m, points_xy.max(axis=0) + reach_m
        rows = [self._rows[wall] for wall in self._boxes.near(low, high)]
        return np.array(sorted(rows), dtype=np.intp)

    def part(self, start_xy: Array, end_xy: Array) -> bool:
        """Whether a wall crosses the straight line between two points (2,), m."""
        return bool(self.part_from(start_xy, end_xy[None])[0])

    def part_from(self, start_xy: Array, ends_xy: Array) -> NDArray[np.bool_]:
        """(N,) whether a wall crosses the straight lines from a point (2,) to points (N, 2), m.

        Shorter bounds than `WALL_M` are fronts and backs of furniture.
        """
        near = self._near(np.vstack([start_xy, ends_xy]))
        a, b = self._ends[near].transpose(1, 0, 2)
        step, wall = (ends_xy - start_xy)[:, None], b - a
        walls = np.linalg.norm(wall, axis=1) >= WALL_M
        denominator = step[..., 0] * wall[:, 1] - step[..., 1] * wall[:, 0]
        to_a = a - start_xy
        with np.errstate(divide="ignore", invalid="ignore"):
            on_line = (to_a[:, 0] * wall[:, 1] - to_a[:, 1] * wall[:, 0]) / denominator
            on_wall = (to_a[:, 0] * step[..., 1] - to_a[:, 1] * step[..., 0]) / denominator
        crosses = (on_line > 0) & (on_line < 1) & (on_wall >= 0) & (on_wall <= 1)
        parted: NDArray[np.bool_] = (crosses & walls).any(axis=1)
        return parted

    def bounds(self) -> list[Bound]:
        """The walls so far, by place; ids are stable as long as nothing is added."""
        walls = sorted(self._walls, key=lambda w: tuple(np.round(w.ends.mean(axis=0), 3)))
        return [
            Bound(
                id=f"bound-{number}",
                start_xy=(float(w.ends[0, 0]), float(w.ends[0, 1])),
                end_xy=(float(w.ends[1, 0]), float(w.ends[1, 1])),
                observations=w.observations,
                generated_by=tuple(sorted(w.detectors)),
                sigmas=w.sigmas,
                first_seen=w.seen[0],
                last_seen=w.seen[1],
            )
            for number, w in enumerate(walls, start=1)
        ]


def across_sigma(segment_xy: Array, covariance_xyz: Array) -> float:
    """Standard deviation of a segment's line across itself, m, from its middle's covariance."""
    along = segment_xy[1] - segment_xy[0]
    normal = np.array([-along[1], along[0]]) / max(float(np.linalg.norm(along)), 1e-9)
    variance = float(normal @ covariance_xyz[:2, :2] @ normal)
    return math.sqrt(variance) if variance > 0 else UNSTATED_SIGMA_M
