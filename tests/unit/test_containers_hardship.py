"""What is and what isn't taken for a container: by shape, and by a sensor worse than its model."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pytest

from afkb.flow import Detection, View
from afkb_containers.detector import ContainerDetector
from afkb_surfaces.detector import SurfaceDetector
from afkb_things.detector import ThingDetector
from depth_samples import FLOOR, Box, Cup, Rays, table, view_of

TABLE = table(1.3, 0.0, 0.73)
MUG = Cup((1.2, 0.1), 0.73, 0.10, 0.045)


class Can(Cup):
    """Closed upright cylinder."""

    def hit(self, origin: Rays, rays: Rays) -> Rays:
        """Distance along each ray, inf where it misses."""
        top = self.base + self.height
        side = self._wall(origin, rays, self.radius, self.base, top, near=True)
        return np.minimum(side, self._disc(origin, rays, top, 0.0, self.radius))


@dataclass(frozen=True)
class Ellipsoid:
    """By its centre and its half axes, m."""

    centre: tuple[float, float, float]
    half: tuple[float, float, float]

    def hit(self, origin: Rays, rays: Rays) -> Rays:
        """Distance along each ray, inf where it misses."""
        d, o = rays / np.array(self.half), (origin - np.array(self.centre)) / np.array(self.half)
        a, b, c = (d * d).sum(-1), (d * o).sum(-1), (o * o).sum(-1) - 1
        with np.errstate(invalid="ignore"):
            return np.where(b * b > a * c, (-b - np.sqrt(b * b - a * c)) / a, np.inf)


@dataclass(frozen=True)
class Turned:
    """A box about its own origin, leaning back by an angle, turned, and moved."""

    box: Box
    at: tuple[float, float, float]
    lean_deg: float = 0.0
    yaw_deg: float = 0.0

    def hit(self, origin: Rays, rays: Rays) -> Rays:
        """Distance along each ray, inf where it misses."""
        p, y = math.radians(self.lean_deg), math.radians(self.yaw_deg)
        lean = np.array([[math.cos(p), 0, math.sin(p)], [0, 1, 0], [-math.sin(p), 0, math.cos(p)]])
        turn = np.array([[math.cos(y), -math.sin(y), 0], [math.sin(y), math.cos(y), 0], [0, 0, 1]])
        R = turn @ lean
        return self.box.hit((origin - np.array(self.at)) @ R, rays @ R)


def worse(view: View, seed: int, noise: float, missing: float) -> View:
    """The view by a sensor of `noise` times the model's noise that loses a share of pixels."""
    assert view.depth_m is not None
    rng, depth = np.random.default_rng(seed), view.depth_m.astype(np.float64)
    sigma = 0.0012 + 0.0019 * (depth - 0.4) ** 2
    depth = depth + (depth > 0) * rng.normal(size=depth.shape) * sigma * noise
    depth[rng.random(depth.shape) < missing] = 0.0
    return replace(view, depth_m=np.maximum(depth, 0.0).astype(np.float32))


def containers(view: View) -> list[Detection]:
    found: list[Detection] = list(SurfaceDetector().detect(view))
    found += ThingDetector().detect(view, found)
    claims = ContainerDetector().detect(view, found)
    return [d for d in claims if d.affords("ContainAbility")]


CLOSED = {
    "can": [Can((1.2, 0.1), 0.73, 0.11, 0.035)],
    "bottle": [Can((1.2, 0.1), 0.73, 0.17, 0.035), Can((1.2, 0.1), 0.90, 0.04, 0.014)],
    "carton": [Turned(Box((-0.03, -0.05, 0.0), (0.03, 0.05, 0.2)), (1.2, 0.1, 0.73), 0.0, 35.0)],
}
NOT = {
    "magazine": [Box((1.1, -0.1, 0.73), (1.38, 0.1, 0.75))],
    "book": [Turned(Box((-0.0125, -0.08, 0.0), (0.0125, 0.08, 0.22)), (1.2, 0.1, 0.73), 0.0, 30.0)],
    "frame": [Turned(Box((-0.008, -0.07, 0.0), (0.008, 0.07, 0.19)), (1.2, 0.1, 0.73), 15.0)],
    "screen": [
        Box((1.2, -0.25, 0.85), (1.23, 0.25, 1.15)),
        Box((1.16, -0.1, 0.73), (1.27, 0.1, 0.75)),
        Box((1.22, -0.03, 0.73), (1.24, 0.03, 0.9)),
    ],
    "controller": [
        Ellipsoid((1.2, 0.05, 0.757), (0.05, 0.03, 0.027)),
        Ellipsoid((1.2, -0.05, 0.757), (0.05, 0.03, 0.027)),
        Box((1.18, -0.05, 0.74), (1.22, 0.05, 0.77)),
    ],
    "cushion": [Ellipsoid((1.2, 0.0, 0.78), (0.2, 0.2, 0.07))],
}


@pytest.mark.parametrize("name", CLOSED)
def test_a_closed_body_contains_intrinsically(name: str) -> None:
    view = worse(view_of([FLOOR, TABLE, *CLOSED[name]]), 5, 1.0, 0.02)
    (found,) = containers(view)
    assert found.affords("IntrinsicContainAbility")
    assert found.position_xyz[:2] == pytest.approx([1.2, 0.1], abs=0.04)
    assert 0.2 < found.measures["volume"] < 3.0


def test_how_much_an_open_one_holds_is_told_as_far_as_it_is_seen() -> None:
    bucket = Cup((1.3, 0.2), 0.0, 0.30, 0.12)
    (found,) = containers(view_of([FLOOR, bucket], pitch_deg=40.0))
    litres = 1e3 * math.pi * 0.116**2 * 0.296
    assert 0.5 * litres < found.measures["volume"] < 1.1 * litres
    assert found.measures["rim_height"] == pytest.approx(0.30, abs=0.01)
    assert found.measures["opening_width"] == pytest.approx(math.sqrt(math.pi) * 0.118, rel=0.1)


@pytest.mark.parametrize("name", NOT)
def test_a_plate_or_a_pad_is_no_container_by_any_sensor(name: str) -> None:
    clean = view_of([FLOOR, TABLE, *NOT[name]])
    for view in (worse(clean, 6, 1.0, 0.02), worse(clean, 7, 3.0, 0.02), worse(clean, 8, 1.0, 0.5)):
        assert containers(view) == []


@pytest.mark.parametrize(("noise", "missing"), [(3.0, 0.02), (1.0, 0.5)])
def test_a_worse_sensor_makes_no_container_of_what_is_none(noise: float, missing: float) -> None:
    found = containers(worse(view_of([FLOOR, TABLE, MUG]), 9, noise, missing))
    assert len(found) <= 1
    for mug in found:
        assert mug.position_xyz == pytest.approx([1.2, 0.1, 0.78], abs=0.03)


def test_a_mug_is_open_even_where_half_of_the_pixels_are_lost() -> None:
    (mug,) = containers(worse(view_of([FLOOR, TABLE, MUG]), 10, 1.0, 0.5))
    assert not mug.affords("IntrinsicContainAbility")


def nothing_but(things: Sequence[Box], pitch_deg: float) -> list[Detection]:
    return containers(worse(view_of([FLOOR, *things], pitch_deg=pitch_deg), 12, 1.0, 0.1))


def test_a_blank_wall_and_a_bare_floor_hold_nothing() -> None:
    assert nothing_but([Box((0.6, -3.0, 0.0), (0.7, 3.0, 3.0))], 10.0) == []
    assert nothing_but([], 70.0) == []
