"""Which files of a folder hold its images, poses and camera."""

from __future__ import annotations

from pathlib import Path

from afkb.errors import SourceError

DEPTH_LIST = "depth.txt"
COLOR_LIST = "rgb.txt"
# `associate.py` of the benchmark's tools writes to a name of the user's choice; these are usual.
ASSOCIATIONS = ("associations.txt", "association.txt", "associate.txt", "associated.txt")
_POSES = ("groundtruth.txt", "odometry.txt", "trajectory.txt")
_ICL_POSES = "*.gt.freiburg"
LAYOUT = "depth.txt, rgb.txt and groundtruth.txt or odometry.txt, as the TUM RGB-D benchmark has it"


def recognises(folder: Path) -> bool:
    """Whether it lists depth images, or holds one folder up what does: an unpacked archive."""
    return _lists_depth(folder) or bool(_sequences(folder))


def checked_folder(folder: Path) -> Path:
    """The folder itself, or the only recording in it; `SourceError` where there are several."""
    if _lists_depth(folder):
        return folder
    found = _sequences(folder)
    if len(found) > 1:
        raise SourceError(f"{folder}: holds {len(found)} recordings; name one, such as {found[0]}")
    return found[0]


def associations(folder: Path) -> Path | None:
    """The association file, if there is one."""
    return next((folder / n for n in ASSOCIATIONS if (folder / n).is_file()), None)


def pose_file(folder: Path, named: str | None) -> Path:
    """The file of poses: the named one, ground truth before odometry; `SourceError` for none."""
    if named is not None:
        if not (folder / named).is_file():
            raise SourceError(f"{folder / named}: no such file; `poses` names a file of the folder")
        return folder / named
    usual = [folder / n for n in _POSES if (folder / n).is_file()]
    found = usual or sorted(folder.glob(_ICL_POSES))
    if not found:
        raise SourceError(
            f"{folder}: no poses; expected {LAYOUT}, or name a file of lines "
            "`stamp tx ty tz qx qy qz qw` with the option poses="
        )
    return found[0]


def _lists_depth(folder: Path) -> bool:
    return (folder / DEPTH_LIST).is_file() or associations(folder) is not None


def _sequences(folder: Path) -> list[Path]:
    return sorted(p for p in folder.iterdir() if p.is_dir() and _lists_depth(p))
