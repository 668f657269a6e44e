"""What stands together, seen from above, told apart where surfaces meet in valleys."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body
from afkb_mapping.image_regions import extent, order_by_label
from afkb_mapping.kernels import kernel
from afkb_mapping.openings import find_opening
from afkb_mapping.sensor_noise import depth_sigma
from afkb_things.patches import contacts, patches_of
from afkb_things.rejoin import INSIDE_SHARE, RIM_SHARE
from afkb_things.scene import Scene
from afkb_things.valleys import valleys

SMOOTH = 0.5
"""Mean depth of the valley in which two patches meet, below which they are of one body."""
LEAST_CONTACT = 3
MOST_PATCHES = 150
"""More patches in one pool are noise that no edge can be told from."""
BODY_M = (0.04, 0.025)
"""Length and middle side from which a part is a body of its own; caps, knobs and handles aren't."""


def split(
    bodies: Sequence[Body], scene: Scene, kinds: NDArray[np.int16], min_pixels: int
) -> Iterator[Body]:
    """The bodies that make up groups of what stands together; `kinds` (H, W) are parted, too."""
    if not bodies:
        return
    pools = np.zeros(scene.depth_m.shape, np.int32)
    for name, body in enumerate(bodies, start=1):
        pools[body.v, body.u] = name
    whole = extent(np.concatenate([b.u for b in bodies]), np.concatenate([b.v for b in bodies]))
    valley = valleys(scene.depth_m, pools, whole, float(scene.intrinsics[0]))
    patches = np.zeros(scene.depth_m.shape, np.int32)
    for name, body in enumerate(bodies, start=1):
        box = body.image_box
        count = patches_of(scene.depth_m, pools, name, kinds, valley, box, patches)
        if not 1 < count <= MOST_PATCHES:
            yield body
            continue
        meet = contacts(scene.depth_m, pools, name, patches, valley, count, box)
        parts = _Parts(body, patches[body.v, body.u], meet, scene.camera_xyz, min_pixels)
        yield from parts.joined()


class _Parts:
    """Patches of one group, joined until those that are left are bodies."""

    def __init__(
        self,
        body: Body,
        of: NDArray[np.int32],
        meet: NDArray[np.float64],
        camera_xyz: NDArray[np.float64],
        min_pixels: int,
    ) -> None:
        self.body, self.meet, self.camera_xyz = body, meet, camera_xyz
        self.min_pixels = min_pixels
        order, starts = order_by_label(of, np.ones(len(meet), np.bool_))
        self.index = {
            k: order[starts[k] : starts[k + 1]]
            for k in range(1, len(meet))
            if starts[k + 1] > starts[k]
        }

    def joined(self) -> Iterator[Body]:
        """The bodies; the group itself where it is one."""
        self._join_smooth()
        self._join_small()
        self._join_hollow()
        if len(self.index) <= 1:
            yield self.body
            return
        for index in self.index.values():
            yield self._part(index)

    def _join(self, a: int, b: int) -> None:
        """Make b a part of a."""
        self.index[a] = np.sort(np.concatenate([self.index[a], self.index.pop(b)]))
        self.meet[a] += self.meet[b]
        self.meet[:, a] += self.meet[:, b]
        self.meet[b] = self.meet[:, b] = 0
        self.meet[a, a] = 0

    def _join_smooth(self) -> None:
        while True:
            touching, depth = self.meet[..., 0], self.meet[..., 1]
            mean = np.where(touching >= LEAST_CONTACT, depth / np.maximum(touching, 1), math.inf)
            a, b = np.unravel_index(int(np.argmin(mean)), mean.shape)
            if not mean[a, b] < SMOOTH:
                return
            self._join(int(a), int(b))

    def _join_small(self) -> None:
        """What is too small for a body belongs to what it touches most, or else to the nearest."""
        for k in sorted(self.index, key=lambda k: len(self.index[k])):
            if len(self.index) == 1 or self._is_body(self.index[k]):
                continue
            near = self.meet[k, :, 0] + 0.01 * self.meet[k, :, 2]
            self._join(int(near.argmax()) if near.max() > 0 else self._nearest(k), k)

    def _nearest(self, k: int) -> int:
        middle = self.body.points[self.index[k]].mean(axis=0)
        apart = {
            j: float(np.abs(self.body.points[index[:: len(index) // 50 + 1]] - middle).sum(1).min())
            for j, index in self.index.items()
            if j != k
        }
        return min(apart, key=lambda j: apart[j])

    def _is_body(self, index: NDArray[np.int64]) -> bool:
        if len(index) < self.min_pixels:
            return False
        middle, longest = _two_sides(self.body.points, self.body.depth_m, index)
        return longest >= BODY_M[0] and middle >= BODY_M[1]

    def _join_hollow(self) -> None:
        """Join what makes a hollow only together: the front of a cup and its inside behind."""
        again = True
        while again:
            again = False
            for a, b in self._pairs():
                if self._are_hollow(a, b):
                    self._join(a, b)
                    again = True
                    break

    def _pairs(self) -> list[tuple[int, int]]:
        names = sorted(self.index)
        met = self.meet[..., 0] + self.meet[..., 2] > 0
        return [(a, b) for a in names for b in names if a < b and met[a, b]]

    def _are_hollow(self, a: int, b: int) -> bool:
        both = self._part(np.sort(np.concatenate([self.index[a], self.index[b]])))
        opening = find_opening(both, self.camera_xyz)
        if opening is None or opening.rim_share < RIM_SHARE:
            return False
        return opening.inside_share >= INSIDE_SHARE

    def _part(self, index: NDArray[np.int64]) -> Body:
        b = self.body
        return replace(
            b, u=b.u[index], v=b.v[index], depth_m=b.depth_m[index], points=b.points[index]
        )


@kernel
def _two_sides(
    points: NDArray[np.float64], depth_m: NDArray[np.float32], index: NDArray[np.int64]
) -> tuple[float, float]:
    """Middle and longest side of a box of such spread as some points have less the noise, m."""
    n = len(index)
    centre, spread, sigma = np.zeros(3), np.zeros((3, 3)), 0.0
    for k in index:
        centre += points[k] / n
        sigma += depth_sigma(depth_m[k]) / n
    for k in index:
        off = points[k] - centre
        for i in range(3):
            for j in range(3):
                spread[i, j] += off[i] * off[j] / n
    own = np.linalg.eigvalsh(spread)
    middle = math.sqrt(12.0 * max(own[1] - sigma * sigma, 0.0))
    return middle, math.sqrt(12.0 * max(own[2] - sigma * sigma, 0.0))
