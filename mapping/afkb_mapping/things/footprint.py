"""Where a thing is, seen from above: cells with how often each was seen, so that views merge."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from afkb_mapping.order_statistics import percentile
from afkb_mapping.things.outlines import outline_of_cells

SEEN_SHARE = 0.2
"""A cell belongs to the outline if it was seen this often, relative to the well-seen cells:
stray points of single frames lie below, whatever the number of frames."""


TRIMMED_SHARE = 0.02


@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """Oriented rectangle and polygon around a footprint: map frame, m and rad; size x ≥ size y."""

    center_xy: tuple[float, float]
    size_xy: tuple[float, float]
    yaw: float
    polygon_xy: NDArray[np.float64]
    area_m2: float


class Footprint:
    """A growing raster of cells `cell_m` wide, aligned with the map frame's axes."""

    def __init__(self, cell_m: float) -> None:
        self.cell_m = cell_m
        self._low = np.zeros(2, dtype=np.int64)
        self._hits = np.zeros((0, 0), dtype=np.uint16)
        self._near: dict[int, NDArray[np.uint8]] = {}
        self._points: NDArray[np.float64] | None = None
        self._box: NDArray[np.float64] | None = None
        self._middle: NDArray[np.float64] | None = None

    def __bool__(self) -> bool:
        return bool(self._hits.size)

    def _cells(self, points_xy: NDArray[np.float64]) -> NDArray[np.int64]:
        cells = np.floor(points_xy / self.cell_m).astype(np.int64)
        keys = np.unique((cells[:, 0] << 32) + (cells[:, 1] + (1 << 31)))
        return np.column_stack([keys >> 32, (keys & 0xFFFFFFFF) - (1 << 31)])

    def _grow(self, low: NDArray[np.int64], high: NDArray[np.int64]) -> None:
        if not self._hits.size:
            self._low, self._hits = low, np.zeros(tuple(high - low + 1), dtype=np.uint16)
            return
        new_low = np.minimum(low, self._low)
        new_high = np.maximum(high, self._low + self._hits.shape - 1)
        before = self._low - new_low
        after = new_high - (self._low + self._hits.shape - 1)
        if before.any() or after.any():
            self._hits = np.pad(self._hits, list(zip(before, after, strict=True)))
            self._low = new_low

    def add(self, points_xy: NDArray[np.float64]) -> None:
        """Count one view's points (N, 2), each cell once."""
        if not len(points_xy):
            return
        self._forget()
        cells = self._cells(points_xy)
        self._grow(cells.min(axis=0), cells.max(axis=0))
        i, j = (cells - self._low).T
        self._hits[i, j] = np.minimum(self._hits[i, j], 65534) + 1

    def absorb(self, other: Footprint) -> None:
        """Take over another footprint's counts."""
        if not other._hits.size:
            return
        self._forget()
        self._grow(other._low, other._low + other._hits.shape - 1)
        i, j = other._low - self._low
        n, m = other._hits.shape
        self._hits[i : i + n, j : j + m] += other._hits

    def give_up(self, points_xy: NDArray[np.float64]) -> None:
        """Forget the cells of points (N, 2) that turned out to be another thing's."""
        cells = self._cells(points_xy) - self._low
        inside = ((cells >= 0) & (cells < self._hits.shape)).all(axis=1)
        i, j = cells[inside].T
        self._hits[i, j] = 0
        self._forget()

    def _forget(self) -> None:
        """Drop what was derived from the counts, since they change."""
        self._near.clear()
        self._points = self._box = self._middle = None

    def mask(self, margin: int = 0) -> NDArray[np.uint8]:
        """Cells that were seen often enough, with `margin` empty cells around."""
        hits, n = self._hits[self._hits > 0], margin
        if not len(hits):
            return np.zeros((1 + 2 * n, 1 + 2 * n), dtype=np.uint8)
        enough = max(1.0, math.ceil(SEEN_SHARE * percentile(hits, 90.0)))
        rows, columns = self._hits.shape
        mask = np.zeros((rows + 2 * n, columns + 2 * n), dtype=np.uint8)
        mask[n : n + rows, n : n + columns] = self._hits >= enough
        return mask

    def share_within(self, points_xy: NDArray[np.float64], reach_m: float) -> float:
        """Share of the points' cells that lie within `reach_m` of this footprint."""
        if not self or not len(points_xy):
            return 0.0
        reach = math.ceil(reach_m / self.cell_m)
        low = (self._low - reach) * self.cell_m
        high = (self._low + self._hits.shape + reach) * self.cell_m
        if (points_xy.max(axis=0) < low).any() or (points_xy.min(axis=0) > high).any():
            return 0.0
        near = self._within(reach)
        cells = self._cells(points_xy) - self._low + reach
        inside = ((cells >= 0) & (cells < near.shape)).all(axis=1)
        i, j = cells[inside].T
        return float(near[i, j].sum() / len(cells))

    def overlap(self, points_xy: NDArray[np.float64]) -> float:
        """Shared cells, as a part of the smaller one's cells."""
        shared = self.share_within(points_xy, 0.0)
        if not shared:
            return 0.0
        count = len(self._cells(points_xy))
        return shared * count / min(count, int(self._within(0).sum()))

    def _within(self, reach: int) -> NDArray[np.uint8]:
        """Mask of the cells within `reach` cells, with that margin; kept until the next view."""
        if reach not in self._near:
            near = self.mask(reach)
            if reach:
                disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
                near = cv2.dilate(near, disc)
            self._near[reach] = near
        return self._near[reach]

    def points(self) -> NDArray[np.float64]:
        """(N, 2) centres of its cells, m."""
        if self._points is None:
            centers = (np.argwhere(self.mask()) + self._low).astype(np.float64) + 0.5
            self._points = np.asarray(centers * self.cell_m, dtype=np.float64)
        return self._points

    def extent(self) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
        """Lower left and upper right corner (2,) around all that was ever seen of it, m; or None.

        Cheap to ask for, and never smaller than `box`.
        """
        if not self._hits.size:
            return None
        corners = np.array([self._low, self._low + self._hits.shape], dtype=np.float64)
        low, high = corners * self.cell_m
        return low, high

    def box(self) -> NDArray[np.float64]:
        """(2, 2) lower left and upper right corner around the centres of its cells, m."""
        if self._box is None:
            points = self.points()
            self._box = np.array([points.min(axis=0), points.max(axis=0)])
        return self._box

    def middle(self) -> NDArray[np.float64]:
        """(2,) middle of `box`, m."""
        if self._middle is None:
            self._middle = self.box().mean(axis=0)
        return self._middle

    def outline(self) -> Outline:
        """Rectangle and polygon around it, gaps up to a few cells closed.

        The rectangle holds the middle 96 % of the evidence along each of its axes, stretched to
        the whole: what single frames add at an edge does not move it.
        """
        margin = 4
        mask = self.mask(margin)
        closed = cv2.morphologyEx(
            mask, cv2.MORPH_CLOSE, np.ones((2 * margin - 1,) * 2, dtype=np.uint8)
        )
        if not closed.any():
            raise ValueError("an empty footprint has no outline")
        low_xy = (self._low - margin).astype(np.float64) * self.cell_m
        polygon = outline_of_cells(closed, self.cell_m, low_xy)
        center, size, yaw = self._rectangle(polygon)
        return Outline(center, size, yaw, polygon, float(closed.sum()) * self.cell_m**2)

    def _rectangle(
        self, corners: NDArray[np.float64]
    ) -> tuple[tuple[float, float], tuple[float, float], float]:
        """Centre, size (longer side first) and yaw, m and rad."""
        (_, _), (width, height), angle = cv2.minAreaRect(corners.astype(np.float32))
        yaw = math.radians(angle) + (math.pi / 2 if width < height else 0.0)
        axes = np.array([[math.cos(yaw), math.sin(yaw)], [-math.sin(yaw), math.cos(yaw)]])
        mask = self.mask().astype(bool)
        hits = self._hits[mask].astype(np.float64)
        weights = np.minimum(hits, np.median(hits))
        along = ((np.argwhere(mask) + self._low + 0.5) * self.cell_m) @ axes.T
        low, high = np.array([_trimmed(values, weights) for values in along.T]).T
        size = (high - low) / (1 - 2 * TRIMMED_SHARE) + self.cell_m
        center = (low + high) / 2 @ axes
        if size[1] > size[0]:
            size, yaw = size[::-1], yaw + math.pi / 2
        yaw = (yaw + math.pi / 2) % math.pi - math.pi / 2
        return (float(center[0]), float(center[1])), (float(size[0]), float(size[1])), yaw


def _trimmed(values: NDArray[np.float64], weights: NDArray[np.float64]) -> tuple[float, float]:
    """Values that cut off `TRIMMED_SHARE` of the weight at either end."""
    order = np.argsort(values, kind="stable")
    share = np.cumsum(weights[order]) / weights.sum()
    low, high = np.searchsorted(share, [TRIMMED_SHARE, 1 - TRIMMED_SHARE])
    return float(values[order][low]), float(values[order][min(high, len(values) - 1)])
