"""A 7-Scenes-style folder as a lazy, re-readable recording."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, PositiveFloat, field_validator

from afkb.errors import BadFrame, SourceError
from afkb.flow import PinholeCamera, SkippedFrame, View
from afkb.plugins.options import read_options
from afkb_mapping.optical import T_BODY_OPTICAL, T_OPTICAL_BODY
from afkb_mapping.recordings.images import common_size, read_color, read_depth
from afkb_mapping.recordings.intrinsics import find_intrinsics

# 7-Scenes has no stamps; its Kinect ran at 30 frames a second.
_FRAMES_PER_SECOND = 30.0
_FRAME = re.compile(r"frame-(\d+)\.(depth\.png|pose\.txt)$")
_LAYOUT = "frame-000000.depth.png, frame-000000.pose.txt … and camera-intrinsics.txt"


class SevenScenesOptions(BaseModel):
    """What a user may say about a folder.

    - `intrinsics`: `fx,fy,cx,cy` in pixels, in place of a file.
    - `depth_scale`: raw depth units a metre.
    - `color`: `registered` if colour pixels lie on depth pixels; 7-Scenes' own do not.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    intrinsics: tuple[float, float, float, float] | None = None
    depth_scale: PositiveFloat = 1000.0
    color: Literal["none", "registered"] = "none"

    @field_validator("intrinsics", mode="before")
    @classmethod
    def _split(cls, value: object) -> object:
        return value.split(",") if isinstance(value, str) else value


@dataclass(eq=False)
class SevenScenesSource:
    """Depth frames with camera poses; the base is the camera's body, the world has no stated up.

    `names`: frame names (`frame-000000`) in order, those with a bad or missing part included.
    """

    uri: str
    folder: Path
    names: tuple[str, ...]
    camera: PinholeCamera
    options: SevenScenesOptions
    gravity_aligned: bool = field(default=False, init=False)

    def __len__(self) -> int:
        return len(self.names)

    def views(
        self, start: int = 0, stop: int | None = None, stride: int = 1
    ) -> Iterator[View | SkippedFrame]:
        """Frames of the slice, read from disk one at a time; the rest is not touched."""
        for index in range(len(self))[start:stop:stride]:
            name = self.names[index]
            try:
                yield self._view(index, name)
            except BadFrame as error:
                yield SkippedFrame(index, str(self.folder / name), str(error))

    def _view(self, index: int, name: str) -> View:
        depth_m = read_depth(self.folder / f"{name}.depth.png", self.options.depth_scale)
        T_world_camera = read_pose(self.folder / f"{name}.pose.txt")
        return View(
            index=index,
            stamp=int(name.removeprefix("frame-")) / _FRAMES_PER_SECOND,
            T_odom_base=T_world_camera @ T_OPTICAL_BODY,
            depth_m=depth_m,
            camera=self.camera,
            T_base_camera=T_BODY_OPTICAL,
            color=self._color(name, depth_m.shape),
            has_base=False,
        )

    def _color(self, name: str, size: tuple[int, ...]) -> NDArray[np.uint8] | None:
        if self.options.color == "none":
            return None
        candidates = (self.folder / f"{name}.color.{ending}" for ending in ("png", "jpg"))
        path = next((p for p in candidates if p.is_file()), None)
        return None if path is None else read_color(path, size)


def read_pose(path: Path) -> NDArray[np.float64]:
    """Camera-to-world transform (4, 4), m; `BadFrame` where it is missing, lost (inf) or NaN."""
    try:
        T = np.array([float(word) for word in path.read_text().split()])
    except FileNotFoundError as error:
        raise BadFrame(f"no {path.name} for this depth image") from error
    except (OSError, ValueError) as error:
        raise BadFrame(f"{path.name}: {error}") from error
    if T.size != 16:
        raise BadFrame(f"{path.name}: {T.size} numbers, a 4x4 pose has 16")
    if not np.isfinite(T).all():
        raise BadFrame(f"{path.name}: pose is not finite (tracking was lost)")
    return T.reshape(4, 4)


def recognises(folder: Path) -> bool:
    """Whether the folder has frames, sequences of frames, or nothing: nobody else wants that."""
    names = [p.name for p in islice(sorted(folder.iterdir()), 10_000)]
    return not names or any(_FRAME.match(n) for n in names) or bool(_sequences(folder))


def _sequences(folder: Path) -> list[str]:
    """Names of sub-folders laid out like a recording, as in a 7-Scenes download."""
    return sorted(
        p.name
        for p in folder.glob("seq*")
        if p.is_dir() and any(_FRAME.match(q.name) for q in p.iterdir())
    )


def open_folder(uri: str, options: Mapping[str, str]) -> SevenScenesSource:
    """The recording; `SourceError` where it cannot give a single view."""
    folder = Path(uri)
    chosen = read_options(SevenScenesOptions, uri, options)
    found = [m for m in map(_FRAME.match, sorted(p.name for p in folder.iterdir())) if m]
    if not found:
        raise SourceError(_nothing_in(folder))
    kinds = Counter(m.group(2) for m in found)
    for kind in ("depth.png", "pose.txt"):
        if not kinds[kind]:
            raise SourceError(f"{folder}: no frame-XXXXXX.{kind}; expected {_LAYOUT}")
    names = sorted({f"frame-{m.group(1)}" for m in found}, key=lambda n: (int(n[6:]), n))
    camera = find_intrinsics(folder, chosen.intrinsics, _common_size(folder, names))
    return SevenScenesSource(uri, folder, tuple(names), camera, chosen)


def _nothing_in(folder: Path) -> str:
    sequences = _sequences(folder)
    if sequences:
        return f"{folder}: holds sequences, not frames; name one, such as {folder / sequences[0]}"
    return f"{folder}: the folder is empty; expected {_LAYOUT}, or another recording"


def _common_size(folder: Path, names: list[str]) -> tuple[int, int]:
    size = common_size(folder / f"{name}.depth.png" for name in names)
    if size is None:
        raise SourceError(f"{folder}: none of its depth images is a PNG; expected {_LAYOUT}")
    return size
