"""Depth images of boxes and cups, ray cast exactly, for tests of depth detectors."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import PinholeCamera, View

CAMERA = PinholeCamera(640, 480, 525.0, 525.0, 319.5, 239.5)
Rays = NDArray[np.float64]


@dataclass(frozen=True)
class Box:
    """Upright box between two corners, m."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]

    def hit(self, origin: Rays, rays: Rays) -> Rays:
        """Distance along each ray, inf where it misses."""
        with np.errstate(divide="ignore", invalid="ignore"):
            a, b = (np.array(self.low) - origin) / rays, (np.array(self.high) - origin) / rays
        near, far = np.minimum(a, b).max(axis=-1), np.maximum(a, b).min(axis=-1)
        return np.where((near <= far) & (near > 0), near, np.inf)


@dataclass(frozen=True)
class Cup:
    """Open upright cylinder with a wall and a bottom, m."""

    centre: tuple[float, float]
    base: float
    height: float
    radius: float
    wall: float = 0.004

    def hit(self, origin: Rays, rays: Rays) -> Rays:
        """Distance along each ray, inf where it misses."""
        top, inner = self.base + self.height, self.radius - self.wall
        outside = self._wall(origin, rays, self.radius, self.base, top, near=True)
        inside = self._wall(origin, rays, inner, self.base + self.wall, top, near=False)
        rim = self._disc(origin, rays, top, inner, self.radius)
        bottom = self._disc(origin, rays, self.base + self.wall, 0.0, inner)
        return np.minimum.reduce([outside, inside, rim, bottom])

    def _wall(
        self, origin: Rays, rays: Rays, radius: float, low: float, high: float, near: bool
    ) -> Rays:
        d, o = rays[..., :2], origin[:2] - np.array(self.centre)
        a, b, c = (d * d).sum(-1), (d * o).sum(-1), o @ o - radius**2
        with np.errstate(invalid="ignore", divide="ignore"):
            root = np.sqrt(b * b - a * c)
            t = (-b - root if near else -b + root) / a
            z = origin[2] + t * rays[..., 2]
            return np.where((t > 0) & (z >= low) & (z <= high), t, np.inf)

    def _disc(self, origin: Rays, rays: Rays, z: float, low: float, high: float) -> Rays:
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (z - origin[2]) / rays[..., 2]
            off = origin[:2] + t[..., None] * rays[..., :2] - np.array(self.centre)
        rho = np.hypot(off[..., 0], off[..., 1])
        return np.where((t > 0) & (rho >= low) & (rho < high), t, np.inf)


FLOOR = Box((-20.0, -20.0, -1.0), (20.0, 20.0, 0.0))


def view_of(
    things: Iterable[Box | Cup],
    height: float = 1.3,
    pitch_deg: float = 30.0,
    rng: np.random.Generator | None = None,
    camera: PinholeCamera = CAMERA,
    roll_deg: float = 0.0,
    noise: float = 1.0,
) -> View:
    """What a camera at (0, 0, height) sees, looking along x and down; noisy with a generator.

    `noise`: how many times a Kinect's. `roll_deg`: turned about its optical axis.
    """
    c, s = math.cos(math.radians(pitch_deg)), math.sin(math.radians(pitch_deg))
    T = np.eye(4)
    T[:3, :3] = np.column_stack([[0, -1, 0], [-s, 0, -c], [c, 0, -s]])
    roll = math.radians(roll_deg)
    turned = [[math.cos(roll), -math.sin(roll), 0], [math.sin(roll), math.cos(roll), 0], [0, 0, 1]]
    T[:3, :3] @= np.array(turned)
    T[2, 3] = height
    u, v = np.meshgrid(np.arange(camera.width), np.arange(camera.height))
    rays = np.stack(
        [(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(u.shape)], axis=-1
    )
    depth = np.minimum.reduce([thing.hit(T[:3, 3], rays @ T[:3, :3].T) for thing in things])
    depth = np.where(np.isfinite(depth) & (depth < 8), depth, 0.0)
    if rng is not None:
        sigma = noise * (0.0012 + 0.0019 * (depth - 0.4) ** 2)
        depth += (depth > 0) * rng.normal(size=depth.shape) * sigma
        depth[rng.random(depth.shape) < 0.02] = 0.0
    depth = np.clip(np.round(depth, 3), 0, None).astype(np.float32)
    return View(0, 0.0, np.eye(4), depth, camera, T, T_map_base=np.eye(4))


def table(x: float, y: float, top: float, length: float = 0.8, width: float = 1.2) -> Box:
    """Table top 3 cm thick around (x, y), without legs."""
    return Box((x - length / 2, y - width / 2, top - 0.03), (x + length / 2, y + width / 2, top))
