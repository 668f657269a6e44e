"""A whole place from a mesh file: put on its floor, and checked to be one a robot fits into."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from afkb.errors import SourceError
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_simulation.casting import Caster
from afkb_simulation.mesh_loading import load_mesh
from afkb_simulation.meshes import Mesh
from afkb_simulation.tour import Stop
from afkb_simulation.world_file import SceneFile, WorldFile

SMALLEST_M, LARGEST_M = 1.5, 500.0
"""Longest side of a place: a bathroom's, and a large building's. Others are in other units."""
_FLOOR_TOLERANCE_M = 0.1
_DOWN = np.array([[0.0, 0.0, -1.0]], dtype=np.float32)
_AROUND = 16


def scene_mesh(scene: SceneFile, path: Path) -> Mesh:
    """The place in the world frame: z up, its floor at 0, m; `SourceError` where units are off."""
    key = f"{path}: scene.file"
    mesh = load_mesh(path.parent / scene.file, scene.up, scene.unit_m, key)
    lower, upper = mesh.bounds
    longest = float((upper - lower).max())
    if not SMALLEST_M <= longest <= LARGEST_M:
        raise SourceError(
            f"{key}: the place measures {_sizes(upper - lower)} m; set scene.unit_m to the length "
            "of its unit (0.01 for centimetres)"
        )
    T = T_from_xy_yaw(*scene.at, math.radians(scene.yaw_deg))
    T[2, 3] = -scene.floor_m
    return mesh.moved(T)


def check_stops(world: WorldFile, stops: Sequence[Stop], mesh: Mesh, path: Path) -> None:
    """Raise `SourceError` where a frame would be taken off the floor or inside the mesh."""
    caster = Caster([mesh])
    for stop in stops:
        key = f"{path}: tour.waypoints ({world.tour.waypoints[stop.leg].name})"
        at = f"({stop.x:.2f}, {stop.y:.2f})"
        height = _height(world)
        floor = height - float(caster.cast(np.array([stop.x, stop.y, height]), _DOWN).distances[0])
        if not abs(floor) <= _FLOOR_TOLERANCE_M:
            below = (
                f"the floor is at {floor:.2f} m" if math.isfinite(floor) else "there is no floor"
            )
            raise SourceError(
                f"{key}: {below} under {at}; floors are at 0: set scene.floor_m or scene.up, or "
                f"move the waypoint; the place reaches {_reach(mesh)}"
            )
        if _blocked(caster, stop, height, world.robot.radius_m):
            raise SourceError(
                f"{key}: the way there runs into the mesh at {at}; lead it around with `via`"
            )


def _blocked(caster: Caster, stop: Stop, height: float, radius: float) -> bool:
    """Whether most of what is around the sensor, a robot's radius away, is inside something."""
    angles = np.arange(_AROUND) * (2 * math.pi / _AROUND)
    around = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(_AROUND)])
    hits = caster.cast(np.array([stop.x, stop.y, height]), around.astype(np.float32))
    return bool((hits.distances < radius).sum() > _AROUND // 2)


def _height(world: WorldFile) -> float:
    camera, laser = world.robot.camera, world.robot.laser
    return camera.height_m if camera else laser.height_m if laser else 1.0


def _sizes(extent: np.ndarray) -> str:
    return " x ".join(f"{side:.3g}" for side in extent)


def _reach(mesh: Mesh) -> str:
    lower, upper = mesh.bounds
    spans = zip("xyz", lower, upper, strict=True)
    return ", ".join(f"{axis} {low:.1f} to {high:.1f}" for axis, low, high in spans)
