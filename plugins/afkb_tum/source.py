"""A folder in TUM's layout as a lazy, re-readable recording."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, NonNegativeFloat, PositiveFloat, field_validator

from afkb.errors import BadFrame, SourceError
from afkb.flow import PinholeCamera, SkippedFrame, View
from afkb.plugins.options import read_options
from afkb_mapping.optical import T_BODY_OPTICAL, T_OPTICAL_BODY
from afkb_mapping.recordings.images import common_size, read_color, read_depth
from afkb_mapping.recordings.pose_file import Damaged, read_poses
from afkb_mapping.recordings.pose_track import NS, T_from_pose, Track
from afkb_tum.camera import find_calibration
from afkb_tum.layout import (
    COLOR_LIST,
    DEPTH_LIST,
    LAYOUT,
    associations,
    checked_folder,
    pose_file,
)
from afkb_tum.lists import Images, read_associations, read_images

DEPTH_SCALE = 5000.0
"""Raw depth units a metre in the benchmark's images, unless a calibration file says otherwise."""
_MIRROR_Y = np.diag([1.0, -1.0, 1.0, 1.0])


class TumOptions(BaseModel):
    """What a user may say about a folder.

    - `intrinsics`: `fx,fy,cx,cy` in pixels; a negative fy for a camera whose y axis points up.
    - `depth_scale`: raw depth units a metre. `color`: `none` spares reading it.
    - `poses`: file of the poses. `mounted`: `x,y,z,qx,qy,qz,qw` of the camera's optical frame on
      what has these poses, a robot's base with z up; left out, they are the camera's own.
    - `max_dt`: s; how far apart two stamps may be to count as the same moment.
    - `max_gap`: s; how far apart two poses may be to interpolate between them.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    intrinsics: tuple[float, float, float, float] | None = None
    depth_scale: PositiveFloat | None = None
    color: Literal["none", "registered"] = "registered"
    poses: str | None = None
    mounted: tuple[float, float, float, float, float, float, float] | None = None
    max_dt: NonNegativeFloat = 0.02
    max_gap: NonNegativeFloat = 0.3

    @field_validator("intrinsics", "mounted", mode="before")
    @classmethod
    def _split(cls, value: object) -> object:
        return value.split(",") if isinstance(value, str) else value


@dataclass(eq=False)
class TumSource:
    """Depth images with poses interpolated at their stamps, and the colour image beside each.

    `stamps`: (N,) ns, of the depth images in order of time. `notes`: what a user should know of
    how the folder was read.
    """

    uri: str
    folder: Path
    depth: Images
    color: Images
    track: Track
    camera: PinholeCamera
    y_is_up: bool
    depth_scale: float
    options: TumOptions
    notes: tuple[str, ...]
    stamps: tuple[int, ...] = field(init=False)
    _color_stamps: NDArray[np.int64] = field(init=False)

    def __post_init__(self) -> None:
        self.stamps = tuple(self.depth.files)
        self._color_stamps = np.array(list(self.color.files), dtype=np.int64)

    @property
    def gravity_aligned(self) -> bool:
        """A robot's poses have z up; what a camera's world is like is not known."""
        return self.options.mounted is not None

    def __len__(self) -> int:
        return len(self.stamps)

    def views(
        self, start: int = 0, stop: int | None = None, stride: int = 1
    ) -> Iterator[View | SkippedFrame]:
        """Frames of the slice, read from disk one at a time; the rest is not touched."""
        for index in range(len(self))[start:stop:stride]:
            stamp = self.stamps[index]
            try:
                yield self._view(index, stamp)
            except BadFrame as error:
                where = f"{self.folder / self.depth.files[stamp]} at {stamp / NS:.6f} s"
                yield SkippedFrame(index, where, str(error))

    def _view(self, index: int, stamp: int) -> View:
        T_world_posed = self.track.at(stamp, self.options.max_dt, self.options.max_gap)
        depth_m = read_depth(self.folder / self.depth.files[stamp], self.depth_scale)
        has_base = self.options.mounted is not None
        return View(
            index=index,
            stamp=stamp / NS,
            T_odom_base=T_world_posed if has_base else self._body(T_world_posed),
            depth_m=depth_m,
            camera=self.camera,
            T_base_camera=self._T_base_camera(),
            color=self._color_at(stamp, depth_m.shape),
            has_base=has_base,
        )

    def _body(self, T_world_camera: NDArray[np.float64]) -> NDArray[np.float64]:
        """The camera's body; a world seen with y up is taken for its mirror image, y down."""
        if self.y_is_up:
            T_world_camera = _MIRROR_Y @ T_world_camera @ _MIRROR_Y
        return T_world_camera @ T_OPTICAL_BODY

    def _T_base_camera(self) -> NDArray[np.float64]:
        mounted = self.options.mounted
        return np.array(T_BODY_OPTICAL) if mounted is None else T_from_pose(mounted)

    def _color_at(self, stamp: int, size: tuple[int, ...]) -> NDArray[np.uint8] | None:
        if self.options.color == "none" or not len(self._color_stamps):
            return None
        nearest = int(self._color_stamps[np.argmin(np.abs(self._color_stamps - stamp))])
        if abs(nearest - stamp) > self.options.max_dt * NS:
            return None
        path = self.folder / self.color.files[nearest]
        return read_color(path, size) if path.is_file() else None


def open_folder(uri: str, options: Mapping[str, str]) -> TumSource:
    """The recording; `SourceError` where it cannot give a single view."""
    chosen = read_options(TumOptions, uri, options)
    if chosen.mounted is not None and not any(chosen.mounted[3:]):
        raise SourceError(f"{uri}: option mounted: its quaternion is zero; 0,0,0,1 turns nothing")
    folder = checked_folder(Path(uri))
    poses = pose_file(folder, chosen.poses)
    lost = Damaged(poses)
    track = read_poses(poses, lost)
    if not len(track):
        raise SourceError(f"{poses}: no pose; expected lines `stamp tx ty tz qx qy qz qw`")
    depth, color, broken = _images(folder)
    size = common_size(folder / file for file in depth.files.values())
    if size is None:
        raise SourceError(f"{folder}: none of the depth images it lists is a PNG that is there")
    camera, y_is_up, stated, guessed = find_calibration(folder, chosen.intrinsics, size)
    _check_stamps(folder, poses, depth, track, chosen)
    if y_is_up and chosen.mounted is not None:
        raise SourceError(
            f"{uri}: a negative fy means a camera whose y points up, and mounted a robot's camera, "
            "whose y points down; give fy as positive, or leave mounted out"
        )
    units = chosen.depth_scale or stated
    notes = [guessed, None if units or _is_benchmark(folder) else _UNITS, lost.note]
    notes += [*(d.note for d in broken), *_of_images(depth), *_of_poses(track)]
    told = tuple(note for note in notes if note)
    scale = units or DEPTH_SCALE
    return TumSource(uri, folder, depth, color, track, camera, y_is_up, scale, chosen, told)


_UNITS = (
    f"depth is taken as {DEPTH_SCALE:g} units a metre, as TUM's is; for millimetres give "
    "depth_scale=1000"
)


def _is_benchmark(folder: Path) -> bool:
    """Whether it is named as TUM names its recordings."""
    return "freiburg" in folder.resolve().name


def _images(folder: Path) -> tuple[Images, Images, list[Damaged]]:
    """Depth and colour by stamp; lists before associations, which leave images out."""
    listed = folder / DEPTH_LIST
    if listed.is_file():
        broken = [Damaged(listed), Damaged(folder / COLOR_LIST)]
        depth = read_images(listed, broken[0])
        has_color = (folder / COLOR_LIST).is_file()
        color = read_images(folder / COLOR_LIST, broken[1]) if has_color else Images()
    else:
        paired = associations(folder)
        assert paired is not None
        listed, broken = paired, [Damaged(paired)]
        depth, color = read_associations(paired, broken[0])
    if not depth.files:
        raise SourceError(f"{listed}: lists no depth image; expected {LAYOUT}")
    return depth, color, broken


def _check_stamps(
    folder: Path, poses: Path, depth: Images, track: Track, options: TumOptions
) -> None:
    """Raise `SourceError` where no depth image has a pose at its time."""
    first, last = track.span
    stamps = np.array(list(depth.files), dtype=np.int64)
    margin = options.max_dt * NS
    if not ((stamps >= first - margin) & (stamps <= last + margin)).any():
        raise SourceError(
            f"{folder}: no depth image has a pose: {poses.name} is of {first / NS:.3f} to "
            f"{last / NS:.3f} s, the images of {stamps[0] / NS:.3f} to {stamps[-1] / NS:.3f} s; "
            "name the poses of this recording with poses="
        )


def _of_images(depth: Images) -> list[str]:
    if not depth.repeated:
        return []
    return [f"{depth.repeated} depth images repeat a stamp; the first of each stamp is used"]


def _of_poses(track: Track) -> list[str]:
    return ["all poses are at one place: did the camera move?"] if track.stands_still else []
