"""A world at work: what its robot senses in each frame, and the truth behind it."""

from __future__ import annotations

import math
from functools import cached_property, lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.errors import SourceError
from afkb.flow import LaserScan, PinholeCamera, View
from afkb_mapping.geometry import T_from_xy_yaw
from afkb_simulation.casting import Caster, Hits, camera_rays, laser_rays, turned
from afkb_simulation.meshes import Mesh
from afkb_simulation.noise import noisy_depth, noisy_ranges
from afkb_simulation.odometry import drifting
from afkb_simulation.placing import Placed, place_all, room_at
from afkb_simulation.rooms import building, openings
from afkb_simulation.scene_mesh import check_stops, scene_mesh
from afkb_simulation.tour import stops
from afkb_simulation.way import check_way
from afkb_simulation.world_file import CameraFile, LaserFile, WorldFile

_FRAME_STREAM, _ODOMETRY_STREAM = 0, 1


class Simulation:
    """Everything about one world; the source hands on only what `view` returns."""

    def __init__(self, world: WorldFile, path: Path) -> None:
        self.world = world
        self.openings = openings(world, path)
        self.placed = place_all(world, path)
        self.stops = stops(world.tour)
        self.T_world_base = [T_from_xy_yaw(s.x, s.y, s.yaw) for s in self.stops]
        check_way(world, self.stops, self.placed, self.present, path)
        self._shell = self._fixed(path)
        rng = np.random.default_rng([world.seed, _ODOMETRY_STREAM])
        self._T_odom_base = drifting(self.T_world_base, world.odometry_drift, rng)
        # labels, heights and depth of one frame share its rays
        self.camera_hits = lru_cache(maxsize=1)(self._camera_hits)
        self._caster_of = lru_cache(maxsize=2)(self._build_caster)

    def _fixed(self, path: Path) -> Mesh:
        """All that stands still: a scene's mesh, else walls, floors and ceilings of the rooms."""
        if self.world.scene is None:
            return building(self.world, self.openings)
        mesh = scene_mesh(self.world.scene, path)
        check_stops(self.world, self.stops, mesh, path)
        return mesh

    @cached_property
    def camera(self) -> PinholeCamera | None:
        """The depth camera's intrinsics, if the robot has one."""
        return _pinhole(self.world.robot.camera) if self.world.robot.camera else None

    @cached_property
    def T_base_camera(self) -> NDArray[np.float64] | None:
        """Camera (optical frame) on the robot."""
        return _T_base_camera(self.world.robot.camera) if self.world.robot.camera else None

    def view(self, index: int) -> View:
        """What the robot senses in one frame, noise and drift included."""
        rng = np.random.default_rng([self.world.seed, _FRAME_STREAM, index])
        camera, laser = self.camera, self.world.robot.laser
        return View(
            index=index,
            stamp=round(index * self.world.tour.frame_s, 6),
            T_odom_base=self._T_odom_base[index].copy(),
            depth_m=self._depth(index, camera, rng) if camera else None,
            camera=camera,
            T_base_camera=self.T_base_camera,
            scan=self._scan(index, laser, rng) if laser else None,
            T_base_laser=_T_base_laser(laser) if laser else None,
        )

    def T_world_camera(self, index: int) -> NDArray[np.float64]:
        """True pose of the camera (optical frame); `SourceError` where the robot has none."""
        if self.T_base_camera is None:
            raise SourceError(f"world {self.world.name!r}: its robot has no camera; give it one")
        return self.T_world_base[index] @ self.T_base_camera

    def _camera_hits(self, index: int) -> Hits:
        """(H, W) exact depth and which mesh each pixel shows: 0 the building, then the things."""
        T = self.T_world_camera(index)
        hits = self._caster(index).cast(T[:3, 3], turned(T, self._camera_rays))
        return Hits(hits.distances, hits.cosines, self._mesh_numbers(index)[hits.meshes])

    def heights(self, index: int) -> NDArray[np.float32]:
        """(H, W) height above the floor of what each pixel of a frame shows, m."""
        T = self.T_world_camera(index)
        along = turned(T, self._camera_rays)[..., 2]
        return np.float32(T[2, 3]) + along * self.camera_hits(index).distances

    def room_of(self, index: int) -> str | None:
        """Name of the room the robot is in, None in a doorway."""
        return room_at(self.world, (self.stops[index].x, self.stops[index].y))

    def present(self, index: int) -> tuple[int, ...]:
        """Indexes of the things that are there in a frame."""
        leg = self.stops[index].leg
        names = [w.name for w in self.world.tour.waypoints]
        return tuple(i for i, p in enumerate(self.placed) if _is_there(p, leg, names))

    @cached_property
    def _camera_rays(self) -> NDArray[np.float32]:
        assert self.camera is not None
        return camera_rays(self.camera)

    def _depth(
        self, index: int, camera: PinholeCamera, rng: np.random.Generator
    ) -> NDArray[np.float32]:
        hits = self.camera_hits(index)
        return noisy_depth(hits, camera.fx, self.world.sensor_noise, rng)

    def _scan(self, index: int, laser: LaserFile, rng: np.random.Generator) -> LaserScan:
        start, increment = _beam_angles(laser)
        T = self.T_world_base[index] @ _T_base_laser(laser)
        angles = start + increment * np.arange(laser.beams, dtype=np.float64)
        hits = self._caster(index).cast(T[:3, 3], turned(T, laser_rays(angles)))
        ranges = noisy_ranges(hits, laser.range, self.world.sensor_noise, rng)
        return LaserScan(ranges, start, increment, *laser.range)

    def _caster(self, index: int) -> Caster:
        return self._caster_of(self.present(index))

    def _build_caster(self, present: tuple[int, ...]) -> Caster:
        things = [self.placed[i].mesh for i in present]
        return Caster([self._shell, *things])

    def _mesh_numbers(self, index: int) -> NDArray[np.int32]:
        """From the caster's mesh index (-1 last) to 0 for the building, 1 + i for thing i."""
        return np.array([0, *(1 + i for i in self.present(index)), -1], dtype=np.int32)


def _is_there(placed: Placed, leg: int, waypoints: list[str]) -> bool:
    presence = placed.thing.present
    if presence is None:
        return True
    first = waypoints.index(presence.from_) if presence.from_ else 0
    last = waypoints.index(presence.until) if presence.until else len(waypoints)
    return first <= leg <= last


def _pinhole(camera: CameraFile) -> PinholeCamera:
    focal = camera.width / 2 / math.tan(math.radians(camera.fov_deg) / 2)
    middle = (camera.width - 1) / 2, (camera.height - 1) / 2
    return PinholeCamera(camera.width, camera.height, focal, focal, *middle)


def _T_base_camera(camera: CameraFile) -> NDArray[np.float64]:
    pitch = math.radians(camera.pitch_down_deg)
    c, s = math.cos(pitch), math.sin(pitch)
    T = np.eye(4)
    T[:3, :3] = np.array([[0, -s, c], [-1, 0, 0], [0, -c, -s]])
    T[:3, 3] = camera.forward_m, 0.0, camera.height_m
    return T


def _T_base_laser(laser: LaserFile) -> NDArray[np.float64]:
    T = np.eye(4)
    T[:3, 3] = laser.forward_m, 0.0, laser.height_m
    return T


def _beam_angles(laser: LaserFile) -> tuple[float, float]:
    """First angle and increment, rad; a full circle doesn't repeat its first beam."""
    fov = math.radians(laser.fov_deg)
    gaps = laser.beams if laser.fov_deg >= 360 else laser.beams - 1
    return -fov / 2, fov / gaps
