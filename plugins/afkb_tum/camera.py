"""The depth camera of a folder: from an option, a calibration file, or the folder's name."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import yaml
from pydantic import BaseModel, ConfigDict, Field, PositiveFloat, ValidationError

from afkb.errors import SourceError
from afkb.flow import PinholeCamera
from afkb_mapping.recordings.intrinsics import camera_of, find_intrinsics, intrinsics_file

Intrinsics = tuple[float, float, float, float]
_NAMES = ("camera.yaml", "intrinsics.yaml", "calibration.yaml", "camera.yml", "intrinsics.yml")
_MEND = "write `fx: …`, `fy: …`, `cx: …`, `cy: …` (pixels) in it"
_FREIBURG: dict[str, Intrinsics] = {
    "1": (517.3, 516.5, 318.6, 255.3),
    "2": (520.9, 521.0, 325.1, 249.7),
    "3": (535.4, 539.2, 320.1, 247.6),
}
"""fx, fy, cx, cy of the colour cameras that the benchmark's three Kinects registered depth to,
as its page on file formats and calibration lists them."""
_FREIBURG_SIZE = (640, 480)


class CalibrationFile(BaseModel):
    """What is read of a calibration file; `depth_scale`: raw depth units a metre."""

    model_config = ConfigDict(extra="ignore", frozen=True)
    fx: float
    fy: float
    cx: float
    cy: float
    depth_scale: PositiveFloat | None = Field(default=None)


class _Loader(yaml.SafeLoader):
    """YAML that takes OpenCV's matrices for mappings."""


_Loader.add_constructor(
    "tag:yaml.org,2002:opencv-matrix", lambda loader, node: loader.construct_mapping(node, True)
)


_NAMED = re.compile(r"freiburg([123])")


def find_calibration(
    folder: Path, given: Intrinsics | None, size: tuple[int, int]
) -> tuple[PinholeCamera, bool, float | None, str | None]:
    """(camera, y_is_up, depth units a metre if stated, a note if it is guessed).

    A negative fy, as ICL-NUIM has it, means that the camera's y axis points up. Raises
    `SourceError` where nothing tells the intrinsics or what tells them is unusable.
    """
    stated = next((folder / n for n in _NAMES if (folder / n).is_file()), None)
    file = read_calibration(stated) if stated is not None else None
    scale = file.depth_scale if file else None
    if given is not None:
        where, mend, values = "option intrinsics", "give it as intrinsics=fx,fy,cx,cy", given
    elif file is not None:
        where, mend, values = str(stated), _MEND, (file.fx, file.fy, file.cx, file.cy)
    elif (text := intrinsics_file(folder)) is not None and _is_meant(text, folder):
        above = text.parent.resolve() != folder.resolve()
        note = f"intrinsics are from {text.name}, one folder up" if above else None
        return find_intrinsics(folder, None, size), False, None, note
    else:
        camera, note = _by_name(folder, size)
        return camera, False, None, note
    fx, fy, cx, cy = values
    return camera_of(where, mend, (fx, abs(fy), cx, cy), size), fy < 0, scale, None


def _is_meant(text: Path, folder: Path) -> bool:
    """Not another data set's file one folder up, where the folder's name tells its camera."""
    return text.parent.resolve() == folder.resolve() or not _NAMED.search(folder.resolve().name)


def _by_name(folder: Path, size: tuple[int, int]) -> tuple[PinholeCamera, str]:
    found = _NAMED.search(folder.resolve().name)
    if found is None or size != _FREIBURG_SIZE:
        raise SourceError(
            f"{folder}: no intrinsics; write {_NAMES[0]} with fx, fy, cx and cy (pixels), or give "
            "the option intrinsics=fx,fy,cx,cy"
        )
    values = _FREIBURG[found[1]]
    told = ",".join(f"{v:g}" for v in values)
    note = f"intrinsics {told} are those of {found[0]}, which the folder is named after"
    return camera_of(found[0], "give intrinsics=fx,fy,cx,cy", values, size), note


def read_calibration(path: Path) -> CalibrationFile:
    """A YAML file of ours, of ORB-SLAM (`Camera.fx`) or of camera_calibration (`camera_matrix`)."""
    try:
        text = re.sub(r"\A\s*%YAML[^\n]*\n", "", path.read_text(encoding="utf-8"))
        content = yaml.load(text, Loader=_Loader)
        return CalibrationFile.model_validate(_plain(content))
    except ValidationError as error:
        first = error.errors()[0]
        raise SourceError(f"{path}: {first['loc'][0]}: {first['msg'].lower()}; {_MEND}") from error
    except (OSError, UnicodeDecodeError, yaml.YAMLError, TypeError, ValueError) as error:
        why = " ".join(str(error).split())
        raise SourceError(f"{path}: no calibration can be read: {why}; {_MEND}") from error


def _plain(content: Any) -> dict[str, Any]:
    """The keys of ours that a mapping has, whatever another tool calls them."""
    if not isinstance(content, dict):
        raise ValueError("it holds no `key: value`")
    plain = {str(k).removeprefix("Camera1.").removeprefix("Camera."): v for k, v in content.items()}
    matrix = content.get("camera_matrix")
    if isinstance(matrix, dict) and len(matrix.get("data", ())) == 9:
        K = matrix["data"]
        plain |= {"fx": K[0], "cx": K[2], "fy": K[4], "cy": K[5]}
    for theirs in ("DepthMapFactor", "RGBD.DepthMapFactor"):
        if theirs in content:
            plain.setdefault("depth_scale", content[theirs])
    return plain
