"""Rendered views with nothing to find, and one with a laid table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import PinholeCamera, View
from afkb_mapping.optical import T_BODY_OPTICAL
from afkb_simulation.casting import Caster, camera_rays, turned
from afkb_simulation.meshes import Mesh, box, lathe
from afkb_simulation.noise import noisy_depth
from afkb_simulation.vessels import hollow_profile
from afkb_simulation.world_file import SensorNoise

SIZES = {"320x240": (320, 240, 262.5), "640x480": (640, 480, 525.0), "1280x720": (1280, 720, 920.0)}
RANGE_M = (0.3, 8.0)
FLOOR = box((-20, -20, -0.5), (20, 20, 0))


@dataclass(frozen=True)
class Stage:
    """A scene: its meshes, the things in it as a home's truth lists them, and the camera's place.

    `camera`: height (m) and how far it looks down (degrees), at x = y = 0, looking along x.
    """

    name: str
    meshes: tuple[Mesh, ...]
    things: tuple[dict[str, Any], ...]
    camera: tuple[float, float]

    def view(self, size: str, rng: np.random.Generator, noise: float = 1.0) -> View:
        """What a Kinect-like camera of that size sees."""
        width, height, focal = SIZES[size]
        camera = PinholeCamera(width, height, focal, focal, (width - 1) / 2, (height - 1) / 2)
        T = _looking(*self.camera)
        hits = Caster(self.meshes).cast(T[:3, 3], turned(T, camera_rays(camera)))
        sensor = SensorNoise(axial_m=0.0012 * noise, axial_per_m2=0.0019 * noise, range=RANGE_M)
        depth = noisy_depth(hits, focal, sensor, rng)
        return View(0, 0.0, np.eye(4), depth, camera, T, T_map_base=np.eye(4))


def _looking(height_m: float, down_deg: float) -> NDArray[np.float64]:
    a = np.radians(down_deg)
    T = np.eye(4)
    T[:3, :3] = [[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]]
    T[2, 3] = height_m
    return T @ T_BODY_OPTICAL


def _wall(distance_m: float) -> Mesh:
    return box((distance_m, -20, 0), (distance_m + 0.1, 20, 8))


def nothing_to_find() -> list[Stage]:
    """Blank walls that fill the view, near and far, floors alone, and a corner of a room."""
    walls = [Stage(f"wall at {d:g} m", (_wall(d),), (), (1.2, 0.0)) for d in (0.6, 1.5, 3.0, 6.0)]
    floors = [Stage(f"floor {d:g}° down", (FLOOR,), (), (1.2, d)) for d in (35.0, 60.0, 90.0)]
    side = box((-20, 1.5, 0), (20, 1.6, 8))
    return [*walls, *floors, Stage("corner", (FLOOR, _wall(3.0), side), (), (1.2, 20.0))]


def laid_table() -> Stage:
    """A table 2 m ahead with a mug, a bowl and a carton, a stool beside it, a wall behind."""
    top = 0.73
    table = box((1.5, -0.7, top - 0.03), (2.3, 0.7, top))
    legs = [box((x, y, 0), (x + 0.05, y + 0.05, top)) for x in (1.5, 2.25) for y in (-0.7, 0.65)]
    vessels = [
        _vessel("025_mug", hollow_profile(0.045, 0.1, 0.005, 0.006), (1.75, -0.3), top),
        _vessel("024_bowl", hollow_profile(0.09, 0.07, 0.006, 0.008), (1.85, 0.0), top),
    ]
    carton = ("003_cracker_box", (1.7, 0.3, top), (1.77, 0.46, top + 0.21))
    stool = ("stool", (1.4, -1.35, 0.0), (1.75, -1.0, 0.45))
    solid = [(box(low, high), _thing(name, low, high)) for name, low, high in (carton, stool)]
    things = [_thing("table", (1.5, -0.7, 0.0), (2.3, 0.7, top)), *(t for _, t in vessels + solid)]
    meshes = (FLOOR, _wall(3.5), table, *legs, *(m for m, _ in vessels + solid))
    return Stage("laid table", meshes, tuple(things), (1.25, 25.0))


def _vessel(
    name: str, profile: list[tuple[float, float]], at: tuple[float, float], base: float
) -> tuple[Mesh, dict[str, Any]]:
    turned_ = lathe(profile)
    mesh = Mesh(turned_.vertices + np.array([*at, base]), turned_.triangles)
    return mesh, _thing(name, mesh.vertices.min(axis=0), mesh.vertices.max(axis=0))


def _thing(name: str, low: Any, high: Any) -> dict[str, Any]:
    return {
        "name": name,
        "category": name,
        "min": [float(v) for v in low],
        "max": [float(v) for v in high],
        "top_height": float(high[2]),
    }
