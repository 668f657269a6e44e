"""Patches of what stands together, joined until those that are left are bodies."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.kernels import kernel
from afkb_mapping.sensor_noise import depth_sigma

SMOOTH = 0.5
"""Mean depth of the valley in which two patches meet, below which they are of one body."""
LEAST_CONTACT = 3
STRAYS = 12
"""Fewer pixels may be noise."""
BODY_M = (0.04, 0.025)
"""Length and middle side from which a part is a body of its own; caps, knobs and handles aren't."""
STEM = 0.10
"""Share of its width by which a head must reach beyond its stem on both sides."""
FLOATS_M = 0.03
TOUCH, DEPTH, BEHIND, LEFT, RIGHT = range(5)
"""Layers of `contacts`; the left end is a negative number."""
COUNT, X, Y, Z, SIGMA, FIRST, LAST, LOWEST = 0, 1, 2, 3, 10, 11, 12, 13
"""Columns of `measures_of`; 4 to 9 are sums of products."""


@kernel
def measures_of(
    of: NDArray[np.int32],
    u: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    points: NDArray[np.float64],
    count: int,
    noise: float,
) -> NDArray[np.float64]:
    """Of each part: pixels; sums of x, y, z, xx, xy, xz, yy, yz, zz, and noise; columns; lowest."""
    out = np.zeros((count + 1, 14))
    out[:, FIRST], out[:, LOWEST], out[:, LAST] = 1e9, 1e9, -1e9
    for k in range(len(of)):
        row = out[of[k]]
        row[COUNT] += 1
        n = 4
        for i in range(3):
            row[1 + i] += points[k, i]
            for j in range(i, 3):
                row[n] += points[k, i] * points[k, j]
                n += 1
        row[SIGMA] += noise * depth_sigma(depth_m[k])
        row[FIRST], row[LAST] = min(row[FIRST], u[k]), max(row[LAST], u[k])
        row[LOWEST] = min(row[LOWEST], points[k, 2])
    return out


def sides_of(row: NDArray[np.float64]) -> tuple[float, float]:
    """Middle and longest side, m, of a box of such spread as a part has, less the noise."""
    n = row[COUNT]
    centre, sigma = row[X : Z + 1] / n, row[SIGMA] / n
    xx, xy, xz, yy, yz, zz = row[4:10] / n
    spread = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) - np.outer(centre, centre)
    own = np.maximum(np.linalg.eigvalsh(spread) - sigma**2, 0.0)
    return math.sqrt(12.0 * own[1]), math.sqrt(12.0 * own[2])


class Parts:
    """Parts by number, what they measure, how they meet (see `contacts`), and what each became."""

    def __init__(
        self,
        measures: NDArray[np.float64],
        meet: NDArray[np.float64],
        base_m: float,
        min_pixels: int,
        cell_px: int,
    ) -> None:
        self.measures, self.meet = measures, meet
        self.base_m, self.min_pixels, self.cell_px = base_m, min_pixels, cell_px
        self.became = np.arange(len(meet), dtype=np.int32)
        self.kept = [k for k in range(1, len(meet)) if measures[k, COUNT] > 0]

    def join(self, a: int, b: int) -> None:
        """Make b a part of a."""
        mine, its = self.measures[a], self.measures[b]
        mine[: SIGMA + 1] += its[: SIGMA + 1]
        mine[FIRST], mine[LAST] = min(mine[FIRST], its[FIRST]), max(mine[LAST], its[LAST])
        mine[LOWEST] = min(mine[LOWEST], its[LOWEST])
        for mine, its in ((self.meet[a], self.meet[b]), (self.meet[:, a], self.meet[:, b])):
            mine[:, :LEFT] += its[:, :LEFT]
            mine[:, LEFT:] = np.maximum(mine[:, LEFT:], its[:, LEFT:])
        for gone in (self.meet[b], self.meet[:, b], self.meet[a, a : a + 1]):
            gone[:, :LEFT], gone[:, LEFT:] = 0, -1e9
        self.became[self.became == b] = a
        self.kept.remove(b)

    def join_smooth(self) -> None:
        """Join what meets on a surface that is smooth or convex, the smoothest first."""
        while True:
            touching, depth = self.meet[..., TOUCH], self.meet[..., DEPTH]
            mean = np.where(touching >= LEAST_CONTACT, depth / np.maximum(touching, 1), math.inf)
            a, b = np.unravel_index(int(np.argmin(mean)), mean.shape)
            if not mean[a, b] < SMOOTH:
                return
            self.join(int(a), int(b))

    def join_small(self) -> None:
        """What is too small for a body belongs to what it touches most, or else to the nearest.

        Strays that touch nothing are noise, and belong to nothing.
        """
        for k in sorted(self.kept, key=lambda k: float(self.measures[k, COUNT])):
            if len(self.kept) == 1 or self._is_body(k):
                continue
            near = self.meet[k, :, TOUCH] + 0.01 * (
                self.meet[k, :, BEHIND] + self.meet[:, k, BEHIND]
            )
            if near.max() > 0:
                self.join(int(near.argmax()), k)
            elif self.measures[k, COUNT] < STRAYS:
                self.kept.remove(k)
            else:
                self.join(self._nearest(k), k)

    def _is_body(self, k: int) -> bool:
        if self.measures[k, COUNT] < self.min_pixels:
            return False
        middle, longest = sides_of(self.measures[k])
        return longest >= BODY_M[0] and middle >= BODY_M[1]

    def _nearest(self, k: int) -> int:
        others = [j for j in self.kept if j != k]
        middles = self.measures[:, X : Z + 1] / np.maximum(self.measures[:, :1], 1)
        apart = np.linalg.norm(middles[others] - middles[k], axis=1)
        return others[int(apart.argmin())]

    def join_floating(self) -> None:
        """Join what floats to its likes and its stem: a shade to its lamp, a screen to its foot.

        Nothing of a head reaches the support, and all that may carry it is one stem that it
        reaches beyond on both sides, as nobody stacks things.
        """
        for k in sorted(self.kept, key=lambda k: float(self.measures[k, COUNT])):
            if not self._floats(k):
                continue
            behind = self.meet[k, :, BEHIND] + self.meet[:, k, BEHIND]
            beside = self.meet[k, :, TOUCH] + behind
            below = [j for j in self.kept if beside[j] > 0]
            standing = [j for j in below if not self._floats(j)] or below
            behind[[j for j in standing if not self._floats(j)]] = 0
            if len(standing) == 1 and self._is_head(k, standing[0]):
                self.join(standing[0], k)
            elif self.meet[k, :, TOUCH].max() < LEAST_CONTACT and behind.max() >= LEAST_CONTACT:
                self.join(int(behind.argmax()), k)

    def _floats(self, k: int) -> bool:
        return bool(self.measures[k, LOWEST] > self.base_m + FLOATS_M)

    def _is_head(self, k: int, stem: int) -> bool:
        """Whether a part reaches to both sides beyond where it meets another."""
        head, meet = self.measures[k], self.meet[k, stem]
        margin = STEM * (head[LAST] - head[FIRST])
        left, right = -meet[LEFT] * self.cell_px, (meet[RIGHT] + 1) * self.cell_px
        return bool(head[FIRST] + margin <= left and right <= head[LAST] - margin)
