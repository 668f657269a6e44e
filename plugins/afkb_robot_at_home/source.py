"""One camera and the laser of a visit in Robot@Home2 as a lazy, re-readable recording."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, NonNegativeFloat, PositiveFloat, field_validator

from afkb.errors import BadFrame, SourceError
from afkb.flow import PinholeCamera, SkippedFrame, View
from afkb.plugins.options import read_options
from afkb_mapping.geometry import inverse
from afkb_mapping.optical import T_BODY_OPTICAL, T_OPTICAL_BODY
from afkb_mapping.recordings.images import common_size, read_depth
from afkb_mapping.recordings.pose_file import Damaged, read_poses
from afkb_mapping.recordings.pose_track import NS, Track
from afkb_robot_at_home.camera import T_from_ypr, T_upright, camera_of_images
from afkb_robot_at_home.database import Database, Observation, seconds

_IMAGE_FOLDERS = ("files/rgbd", "rgbd")


class RobotAtHomeOptions(BaseModel):
    """Which visit to read, and what the database does not say.

    - `home`, `session` (from 0), `room`: what to read. `camera`, `laser`: sensors by name.
    - `trajectory`: file of the robot's poses, lines `stamp tx ty tz qx qy qz qw` (s since 1970).
    - `depth_scale`: raw units a metre. `intrinsics`: fx,fy,cx,cy of the stored images, pixels.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    home: str | None = None
    session: int | None = None
    room: str | None = None
    camera: str = "RGBD_1"
    laser: str = "HOKUYO1"
    trajectory: Path | None = None
    depth_scale: PositiveFloat = 1000.0
    intrinsics: tuple[float, float, float, float] | None = None
    max_dt: NonNegativeFloat = 0.1
    max_gap: NonNegativeFloat = 0.3

    @field_validator("intrinsics", mode="before")
    @classmethod
    def _split(cls, value: object) -> object:
        return value.split(",") if isinstance(value, str) else value


@dataclass(eq=False)
class RobotAtHomeSource:
    """Depth images of one camera, each with the laser scan nearest in time.

    `track`: the robot's poses; None where the images' own poses are the camera's in the home.
    """

    uri: str
    database: Database
    folder: Path
    images: Sequence[Observation]
    scans: Sequence[Observation]
    track: Track | None
    camera: PinholeCamera
    options: RobotAtHomeOptions
    notes: tuple[str, ...]
    gravity_aligned: bool = True

    def __len__(self) -> int:
        return len(self.images)

    def views(
        self, start: int = 0, stop: int | None = None, stride: int = 1
    ) -> Iterator[View | SkippedFrame]:
        """Frames of the slice, read from disk one at a time; the rest is not touched."""
        for index in range(len(self))[start:stop:stride]:
            image = self.images[index]
            try:
                yield self._view(index, image)
            except BadFrame as error:
                where = f"{self.uri} observation {image.id} at {seconds(image.stamp):.3f} s"
                yield SkippedFrame(index, where, str(error))

    def _view(self, index: int, image: Observation) -> View:
        new_path, file = image.about
        depth_m = read_depth(self.folder / str(new_path) / str(file), self.options.depth_scale)
        T_base_camera = T_upright(T_from_ypr(image.pose))
        if self.track is None:
            T_odom_base = T_base_camera @ T_OPTICAL_BODY
            return View(
                index, seconds(image.stamp), T_odom_base, depth_m, self.camera,
                np.array(T_BODY_OPTICAL), has_base=False,
            )  # fmt: skip
        T_odom_base = self._robot(self.track, image.stamp)
        beside = self._scan_near(image.stamp)
        return View(
            index=index,
            stamp=seconds(image.stamp),
            T_odom_base=T_odom_base,
            depth_m=depth_m,
            camera=self.camera,
            T_base_camera=T_base_camera,
            scan=None if beside is None else self.database.scan(beside),
            T_base_laser=None if beside is None else self._T_base_laser(T_odom_base, beside),
        )

    def _robot(self, track: Track, stamp: int) -> NDArray[np.float64]:
        return track.at(stamp, self.options.max_dt, self.options.max_gap)

    def _scan_near(self, stamp: int) -> Observation | None:
        after = bisect_left(self.scans, stamp, key=lambda scan: scan.stamp)
        around = self.scans[max(after - 1, 0) : after + 1]
        near = min(around, key=lambda scan: abs(scan.stamp - stamp), default=None)
        if near is None or abs(near.stamp - stamp) > self.options.max_dt * NS:
            return None
        return near

    def _T_base_laser(
        self, T_odom_base: NDArray[np.float64], scan: Observation
    ) -> NDArray[np.float64]:
        """Where the laser was when it scanned, seen from where the robot was at the image."""
        assert self.track is not None
        return inverse(T_odom_base) @ self._robot(self.track, scan.stamp) @ T_from_ypr(scan.pose)


def open_database(uri: str, path: Path, options: Mapping[str, str]) -> RobotAtHomeSource:
    """The visit; `SourceError` where it is not one visit, or its robot's poses are not known."""
    chosen = read_options(RobotAtHomeOptions, uri, options)
    database = Database(path)
    home, session = _visit(database, chosen)
    images = database.images(home, session, chosen.camera, chosen.room)
    if not images:
        raise SourceError(
            f"{path}: no image of {chosen.camera} in session {session} of {home!r}"
            f"{f', room {chosen.room!r}' if chosen.room else ''}; choose camera=, session= or room="
        )
    folder = _image_folder(path)
    size = common_size(folder / str(i.about[0]) / str(i.about[1]) for i in images)
    if size is None:
        raise SourceError(
            f"{folder}: none of the visit's {len(images)} depth images is a PNG there"
        )
    camera = camera_of_images(size, chosen.intrinsics, str(folder))
    track, notes = _track(path, images, chosen)
    scans = [] if track is None else database.scans(home, session, chosen.laser, chosen.room)
    return RobotAtHomeSource(
        uri, database, folder, images, scans, track, camera, chosen, tuple(notes)
    )


def _visit(database: Database, chosen: RobotAtHomeOptions) -> tuple[str, int]:
    visits = database.visits()
    fitting = [
        (home, session)
        for home, session in visits
        if chosen.home in (None, home) and chosen.session in (None, session)
    ]
    if len(fitting) != 1:
        listed = ", ".join(f"home={home} session={session}" for home, session in visits) or "none"
        raise SourceError(
            f"{database.path}: name one visit by the options home= and session=; there is {listed}"
        )
    return fitting[0]


def _image_folder(path: Path) -> Path:
    for name in _IMAGE_FOLDERS:
        if (path.parent / name).is_dir():
            return path.parent / name
    raise SourceError(
        f"{path.parent}: no {_IMAGE_FOLDERS[0]}; unpack the images beside {path.name}"
    )


def _track(
    path: Path, images: Sequence[Observation], chosen: RobotAtHomeOptions
) -> tuple[Track | None, list[str]]:
    """The robot's poses, from a file; none where the images' own poses move through the home."""
    if chosen.trajectory is not None:
        lost = Damaged(chosen.trajectory)
        track = read_poses(chosen.trajectory, lost)
        if not len(track):
            raise SourceError(
                f"{chosen.trajectory}: no pose; expected `stamp tx ty tz qx qy qz qw`"
            )
        return track, [lost.note] if lost.note else []
    if len({image.pose for image in images}) > 1:
        return None, ["no trajectory given: the images' own poses are taken for the camera's"]
    raise SourceError(
        f"{path}: says where {chosen.camera} sits on the robot but not where the robot was; give "
        "its poses as the option trajectory=FILE, lines `stamp tx ty tz qx qy qz qw` (s since 1970)"
    )
