"""The `*.world.yaml` format: what a file may say. See docs/worlds.md."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from afkb_simulation.file_types import (
    XY,
    Category,
    Coordinate,
    Degrees,
    FileName,
    Limits,
    Name,
    NotNegative,
    Positive,
    Probability,
    Strict,
    Up,
)
from afkb_simulation.polygons import crosses_itself, signed_area
from afkb_simulation.shapes import SHAPES, Shape

MESH = "mesh"


class RoomFile(Strict):
    """A room by its inner wall faces: `rectangle` [x0, y0, x1, y1] or `polygon`; m."""

    name: Name
    category: Category
    rectangle: tuple[Coordinate, Coordinate, Coordinate, Coordinate] | None = None
    polygon: tuple[XY, ...] | None = None
    wall_height: Annotated[float, Field(ge=0.5, le=20)] = 2.5

    @model_validator(mode="after")
    def _has_one_outline(self) -> RoomFile:
        if (self.rectangle is None) == (self.polygon is None):
            raise ValueError("give either a rectangle [x0, y0, x1, y1] or a polygon")
        polygon = self.polygon or ()
        if self.polygon is not None and len(set(polygon)) != max(3, len(polygon)):
            raise ValueError("the outline needs at least three corners, each given once")
        if abs(signed_area(self.corners)) < 0.1:
            raise ValueError("the outline encloses no area; give its corners in order")
        if crosses_itself(self.corners):
            raise ValueError("the outline crosses itself; give the corners in order around it")
        return self

    @property
    def corners(self) -> tuple[XY, ...]:
        """Its outline, counter-clockwise, m."""
        if self.rectangle is not None:
            x0, y0, x1, y1 = self.rectangle
            x0, x1, y0, y1 = min(x0, x1), max(x0, x1), min(y0, y1), max(y0, y1)
            return (x0, y0), (x1, y0), (x1, y1), (x0, y1)
        polygon = self.polygon or ()
        return polygon if signed_area(polygon) > 0 else tuple(reversed(polygon))


class DoorwayFile(Strict):
    """An opening between two rooms; `at` is its middle, anywhere within the wall; m."""

    between: tuple[Name, Name]
    at: XY
    width: Annotated[float, Field(ge=0.3, le=10)] = 0.85
    height: Annotated[float, Field(ge=0.5, le=20)] = 2.0


class Presence(Strict):
    """A thing that comes or goes: there from the way to one waypoint until another is left."""

    from_: Annotated[Name | None, Field(alias="from")] = None
    until: Name | None = None


class ThingFile(Strict):
    """Furniture or a small thing; `at` is in the room, or relative to what it stands `on`."""

    name: Name
    shape: str
    category: Category
    at: XY = (0.0, 0.0)
    yaw_deg: Degrees = 0.0
    size: tuple[Positive, Positive, Positive] | None = None
    on: Name | None = None
    level: Annotated[int, Field(ge=0)] = 0
    z: NotNegative = 0.0
    present: Presence | None = None
    seat_m: Positive | None = None
    headboard_m: Positive | None = None
    boards: Annotated[int, Field(ge=2, le=20)] | None = None
    wall_m: Positive | None = None
    file: FileName | None = None
    up: Up | None = None
    unit_m: Positive = 1.0

    @model_validator(mode="after")
    def _fits_its_shape(self) -> ThingFile:
        if self.shape not in (*SHAPES, MESH):
            raise ValueError(f"no shape {self.shape!r}; shapes: {', '.join(sorted(SHAPES))}, mesh")
        if (self.shape == MESH) != (self.file is not None):
            raise ValueError("a mesh takes a `file`, and nothing else does; add or remove it")
        if self.file is None and (self.up is not None or self.unit_m != 1.0):
            raise ValueError("up and unit_m are a mesh file's; remove them")
        for key in ("seat_m", "headboard_m", "boards", "wall_m"):
            if getattr(self, key) is not None and key not in self._usual.parameters:
                raise ValueError(f"a {self.shape} takes no {key}; remove it")
        self._check_proportions()
        return self

    def _check_proportions(self) -> None:
        x, y, z = self.dimensions
        parameters = self.parameters
        if parameters.get("seat_m", 0) > z:
            raise ValueError(f"seat_m {parameters['seat_m']} is above its height {z}")
        if 2 * parameters.get("wall_m", 0) >= min(x, y) or parameters.get("wall_m", 0) >= z:
            raise ValueError(f"wall_m {parameters['wall_m']} leaves nothing hollow in {x}x{y}x{z}")

    @property
    def _usual(self) -> Shape:
        return SHAPES.get(self.shape, SHAPES["block"])

    @property
    def dimensions(self) -> tuple[float, float, float]:
        """Its size, the shape's usual one unless given, m; a mesh file's own is not known here."""
        return self.size or self._usual.size

    @property
    def parameters(self) -> dict[str, float]:
        """What else shapes it, the shape's usual values unless given."""
        usual = self._usual.parameters
        given = {key: getattr(self, key) for key in usual}
        return {key: usual[key] if value is None else value for key, value in given.items()}


class SceneFile(Strict):
    """A scanned or modelled place as one mesh file, in place of walls made of `rooms`.

    - `up`: its axis that points up; left out, y for glTF and z for the rest. `unit_m`: its unit.
    - `at`: where its origin lies, m; `floor_m`: height of its floor there, m, which becomes 0.
    """

    file: FileName
    up: Up | None = None
    unit_m: Positive = 1.0
    yaw_deg: Degrees = 0.0
    at: XY = (0.0, 0.0)
    floor_m: Coordinate = 0.0


class CameraFile(Strict):
    """Depth camera: pixels, horizontal field of view, where it sits on the robot."""

    width: Annotated[int, Field(ge=16, le=4096)] = 640
    height: Annotated[int, Field(ge=16, le=4096)] = 480
    fov_deg: Annotated[float, Field(gt=5, lt=150)] = 62.7
    forward_m: Coordinate = 0.1
    height_m: Positive = 1.2
    pitch_down_deg: Annotated[float, Field(ge=-80, le=80)] = 15.0


class LaserFile(Strict):
    """Planar laser scanner."""

    beams: Annotated[int, Field(ge=2, le=10000)] = 720
    fov_deg: Annotated[float, Field(gt=1, le=360)] = 360.0
    forward_m: Coordinate = 0.0
    height_m: Positive = 0.25
    range: Limits = (0.05, 12.0)


class RobotFile(Strict):
    """The robot's body and sensors; leave a sensor null and views carry none."""

    radius_m: Positive = 0.2
    camera: CameraFile | None = CameraFile()
    laser: LaserFile | None = LaserFile()

    @model_validator(mode="after")
    def _senses_something(self) -> RobotFile:
        if self.camera is None and self.laser is None:
            raise ValueError("camera and laser are both null; keep one of them")
        return self


class SensorNoise(Strict):
    """Kinect-like depth noise and laser noise; all zero for perfect sensors.

    Axial sigma is `axial_m + axial_per_m2 (z - 0.4)²` (Nguyen, Izadi, Lovell 2012).
    """

    axial_m: NotNegative = 0.0012
    axial_per_m2: NotNegative = 0.0019
    disparity_step_px: NotNegative = 0.125
    baseline_m: Positive = 0.075
    edge_dropout: Probability = 0.5
    grazing_deg: Annotated[float, Field(ge=0, le=90)] = 8.0
    range: Limits = (0.4, 6.0)
    laser_m: NotNegative = 0.01


class OdometryDrift(Strict):
    """Bias and noise of odometry, as standard deviations per metre driven and radian turned."""

    along_per_m: NotNegative = 0.01
    yaw_per_m: NotNegative = 0.005
    yaw_per_rad: NotNegative = 0.01


class WaypointFile(Strict):
    """Where the robot stops to look: drive `via`, stop `at`, face `yaw_deg`, then each look."""

    name: Name
    at: XY
    yaw_deg: Degrees
    via: tuple[XY, ...] = ()
    looks_deg: Annotated[tuple[Degrees, ...], Field(min_length=1)] = (0.0,)


class TourFile(Strict):
    """The robot's tour; consecutive frames are at most `step_m` and `turn_deg` apart."""

    step_m: Annotated[float, Field(ge=0.1, le=10)] = 0.45
    turn_deg: Annotated[float, Field(ge=5, le=180)] = 28.0
    frame_s: Positive = 0.5
    waypoints: Annotated[tuple[WaypointFile, ...], Field(min_length=1)]


class WorldFile(Strict):
    """A whole world."""

    name: Name
    seed: Annotated[int, Field(ge=0)] = 0
    scene: SceneFile | None = None
    rooms: tuple[RoomFile, ...] = ()
    doorways: tuple[DoorwayFile, ...] = ()
    things: tuple[ThingFile, ...] = ()
    robot: RobotFile = RobotFile()
    sensor_noise: SensorNoise = SensorNoise()
    odometry_drift: OdometryDrift = OdometryDrift()
    tour: TourFile

    @model_validator(mode="after")
    def _is_somewhere(self) -> WorldFile:
        if not self.rooms and self.scene is None:
            raise ValueError("a world needs rooms, or a scene: a mesh file; add one of them")
        return self
