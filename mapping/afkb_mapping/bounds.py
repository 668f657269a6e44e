"""Bounds of the map: wall segments of many views, merged into one straight piece per wall side."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Bound, Detection

Array = NDArray[np.float64]

OFFSET_M = 0.08
"""Segments whose ends lie this near one line are one wall; the two sides of a wall are further."""
ANGLE_RAD = np.deg2rad(8.0)
"""Greatest angle between them: short segments in noise turn that far, corners further."""
WALL_M = 1.0
GAP_M = 0.3
"""Ends this near are one wall with something before it; a doorway is wider."""


@dataclass(slots=True)
class _Wall:
    """Evidence for one wall: moments of all its segments, from which its line is fitted.

    `mass`: summed lengths, m. `first`: (2,), `second`: (2, 2) moments, m² and m³.
    """

    ends: Array
    mass: float
    first: Array
    second: Array
    observations: int
    detectors: set[str] = field(default_factory=set)

    @classmethod
    def of(cls, segment: Array, detector: str) -> _Wall:
        length = float(np.linalg.norm(segment[1] - segment[0]))
        middle, half = segment.mean(axis=0), (segment[1] - segment[0]) / 2
        spread = np.outer(middle, middle) + np.outer(half, half) / 3
        return cls(segment.copy(), length, length * middle, length * spread, 1, {detector})

    def absorb(self, other: _Wall) -> None:
        """Take over another wall's evidence; the line is fitted anew, the ends reach as far."""
        self.mass += other.mass
        self.first = self.first + other.first
        self.second = self.second + other.second
        self.observations += other.observations
        self.detectors |= other.detectors
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

    def add(self, detection: Detection, place: str | None = None) -> None:
        """Take in one detected bound; `place`, the id of the robot place, is for the caller's log.

        Raises `ValueError` for a detection without a segment.
        """
        if detection.segment_xy is None:
            raise ValueError(f"{detection.detector}: a bound needs segment_xy")
        self.add_segment(detection.segment_xy, detection.detector)

    def add_segment(self, segment_xy: Array, detector: str) -> None:
        """Take in one segment (2, 2), m, map frame."""
        segment = np.asarray(segment_xy, dtype=np.float64)
        if np.linalg.norm(segment[1] - segment[0]) < 1e-6:
            return
        wall = _Wall.of(segment, detector)
        # What the wall grew by may close the gap to the next: hence until nothing fits any more.
        while (index := self._match(wall.ends)) is not None:
            known = self._remove(index)
            known.absorb(wall)
            wall = known
        self._append(wall)

    def _append(self, wall: _Wall) -> None:
        if len(self._walls) == len(self._ends):
            self._ends = np.concatenate([self._ends, np.zeros_like(self._ends)])
        self._ends[len(self._walls)] = wall.ends
        self._walls.append(wall)

    def _remove(self, index: int) -> _Wall:
        """Take a wall out; the last one takes its row."""
        wall, last = self._walls[index], self._walls.pop()
        if last is not wall:
            self._walls[index], self._ends[index] = last, last.ends
        return wall

    def _match(self, segment: Array) -> int | None:
        """Index of the wall that a segment continues or repeats, the one it fits best."""
        if not self._walls:
            return None
        offset, gap, angle = _relation(self._ends[: len(self._walls)], segment)
        fits = (offset < OFFSET_M) & (gap < GAP_M) & (angle < ANGLE_RAD)
        return int(np.argmin(np.where(fits, offset, np.inf))) if fits.any() else None

    def part(self, start_xy: Array, end_xy: Array) -> bool:
        """Whether a wall crosses the straight line between two points (2,), m.

        Shorter bounds than `WALL_M` are fronts and backs of furniture.
        """
        if not self._walls:
            return False
        a, b = self._ends[: len(self._walls)].transpose(1, 0, 2)
        step, wall = end_xy - start_xy, b - a
        walls = np.linalg.norm(wall, axis=1) >= WALL_M
        denominator = step[0] * wall[:, 1] - step[1] * wall[:, 0]
        to_a = a - start_xy
        with np.errstate(divide="ignore", invalid="ignore"):
            on_line = (to_a[:, 0] * wall[:, 1] - to_a[:, 1] * wall[:, 0]) / denominator
            on_wall = (to_a[:, 0] * step[1] - to_a[:, 1] * step[0]) / denominator
        crosses = (on_line > 0) & (on_line < 1) & (on_wall >= 0) & (on_wall <= 1)
        return bool((crosses & walls).any())

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
            )
            for number, w in enumerate(walls, start=1)
        ]


def _relation(walls: Array, segment: Array) -> tuple[Array, Array, Array]:
    """Of each wall (N, 2, 2) to a segment (2, 2): offset (m), gap along the line (m), angle (rad).

    Both are held against the line of the longer one, as a short one's direction is worth little.
    """
    spans = walls[:, 1] - walls[:, 0]
    lengths = np.linalg.norm(spans, axis=1)
    span = segment[1] - segment[0]
    length = float(np.linalg.norm(span))
    longer = lengths >= length
    base = np.where(longer[:, None], walls[:, 0], segment[0])
    along = np.where(longer[:, None], spans / lengths[:, None], span / length)
    reach = np.maximum(lengths, length)
    other = np.where(longer[:, None, None], segment[None], walls) - base[:, None]
    across = other[..., 1] * along[:, None, 0] - other[..., 0] * along[:, None, 1]
    on_line = (other * along[:, None]).sum(axis=2)
    gap = np.maximum(np.maximum(on_line.min(axis=1) - reach, -on_line.max(axis=1)), 0.0)
    cross = np.abs(spans[:, 0] * span[1] - spans[:, 1] * span[0])
    return np.abs(across).max(axis=1), gap, np.arcsin(np.clip(cross / (lengths * length), 0, 1))
