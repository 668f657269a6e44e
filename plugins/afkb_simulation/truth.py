"""The truth behind a simulated world, for tests and benchmarks alone: no source gives it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from afkb.flow import OrientedBox, PinholeCamera
from afkb_simulation.placing import Placed
from afkb_simulation.polygons import XY, signed_area
from afkb_simulation.reading import read_world, world_path
from afkb_simulation.rooms import Opening
from afkb_simulation.simulation import Simulation
from afkb_simulation.world_file import RoomFile


@dataclass(frozen=True, slots=True)
class TrueThing:
    """A thing as it is; world frame, m. `dynamic`: it comes or goes during the tour."""

    name: str
    shape: str
    category: str
    room: str
    box: OrientedBox
    top_height: float
    on: str | None
    dynamic: bool
    frames: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class TrueRoom:
    """A room as it is: category, outline (counter-clockwise, m) and area (m²)."""

    name: str
    category: str
    polygon: tuple[XY, ...]
    area: float


@dataclass(frozen=True, slots=True)
class TrueDoorway:
    """An opening between two rooms: its middle, width and height, m."""

    rooms: tuple[str, str]
    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True, slots=True)
class TrueWaypoint:
    """A stop of the tour: where, in which room, and the frames taken there; m."""

    name: str
    x: float
    y: float
    room: str
    frames: tuple[int, ...]


@dataclass(frozen=True, slots=True, eq=False)
class WorldTruth:
    """Everything that is so in a world.

    - `T_world_base`: per frame, the true base pose (4x4); frame 0's is the odometry's origin.
    - `things`, `rooms`, `waypoints`: by name. `frame_rooms`: per frame, the room of the robot,
      None in a doorway.
    """

    T_world_base: tuple[NDArray[np.float64], ...]
    things: Mapping[str, TrueThing]
    rooms: Mapping[str, TrueRoom]
    doorways: tuple[TrueDoorway, ...]
    waypoints: Mapping[str, TrueWaypoint]
    frame_rooms: tuple[str | None, ...]
    _simulation: Simulation

    @property
    def camera(self) -> PinholeCamera | None:
        """The depth camera's intrinsics."""
        return self._simulation.camera

    def T_world_camera(self, index: int) -> NDArray[np.float64]:
        """True pose (4x4) of the camera's optical frame."""
        return self._simulation.T_world_camera(index)

    def exact_depth(self, index: int) -> NDArray[np.float32]:
        """(H, W) depth of a frame without noise, m; inf where there is nothing."""
        return self._simulation.camera_hits(index).distances

    def labels(self, index: int) -> tuple[NDArray[np.int32], tuple[str, ...]]:
        """(H, W) index into the returned names of what each pixel of a frame shows."""
        names = ("building", *(p.thing.name for p in self._simulation.placed))
        return self._simulation.camera_hits(index).meshes, names

    def visible_pixels(self, index: int) -> dict[str, int]:
        """In how many pixels of a frame each thing is seen; the unseen are left out."""
        labels, names = self.labels(index)
        counts = np.bincount(labels[labels >= 0], minlength=len(names))
        return {n: int(c) for n, c in zip(names, counts, strict=True) if c and n != "building"}

    def heights(self, index: int) -> NDArray[np.float32]:
        """(H, W) height above the floor of what each pixel of a frame shows, m."""
        return self._simulation.heights(index)


def load_truth(path: str) -> WorldTruth:
    """The truth of the world behind a path or `world:NAME`."""
    world = read_world(path)
    simulation = Simulation(world, world_path(path))
    frames = range(len(simulation.stops))
    present = [frozenset(simulation.present(i)) for i in frames]
    things = [
        _thing(p, tuple(f for f in frames if i in present[f]))
        for i, p in enumerate(simulation.placed)
    ]
    return WorldTruth(
        tuple(simulation.T_world_base),
        {t.name: t for t in things},
        {r.name: _room(r) for r in world.rooms},
        tuple(_doorway(pair) for pair in simulation.openings),
        {w.name: w for w in _waypoints(simulation)},
        tuple(simulation.room_of(i) for i in frames),
        simulation,
    )


def _thing(placed: Placed, frames: tuple[int, ...]) -> TrueThing:
    thing = placed.thing
    return TrueThing(
        thing.name,
        thing.shape,
        thing.category,
        placed.room,
        placed.box,
        placed.top_height,
        thing.on,
        thing.present is not None,
        frames,
    )


def _room(room: RoomFile) -> TrueRoom:
    return TrueRoom(room.name, room.category, room.corners, signed_area(room.corners))


def _doorway(pair: tuple[Opening, Opening]) -> TrueDoorway:
    first, second = pair
    corners = np.array([first.a, first.b, second.a, second.b])
    x, y = corners.mean(axis=0)
    width = first.end - first.start
    return TrueDoorway((first.room, second.room), float(x), float(y), width, first.height)


def _waypoints(simulation: Simulation) -> list[TrueWaypoint]:
    found = []
    for leg, waypoint in enumerate(simulation.world.tour.waypoints):
        stops = enumerate(simulation.stops)
        frames = tuple(i for i, s in stops if s.leg == leg and s.look)
        room = simulation.room_of(frames[0]) or ""
        found.append(TrueWaypoint(waypoint.name, *waypoint.at, room, frames))
    return found
