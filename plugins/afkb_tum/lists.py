"""The benchmark's text files: lists of images by stamp, associations, trajectories."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from afkb.errors import SourceError
from afkb_mapping.recordings.pose_track import NS, Track


@dataclass
class Damaged:
    """Lines of a file that could not be read: how many, and where the first one is."""

    path: Path
    count: int = 0
    first: str = ""

    def add(self, number: int, why: str) -> None:
        """Count one more."""
        self.first = self.first or f"line {number}: {why}"
        self.count += 1

    @property
    def note(self) -> str | None:
        """What to tell the user, None if all is well."""
        if not self.count:
            return None
        lines = "1 line" if self.count == 1 else f"{self.count} lines"
        return f"{self.path.name}: {lines} left out as unreadable, the first {self.first}"


@dataclass
class Images:
    """Files by stamp (ns), in order of time; `repeated`: entries whose stamp was there before."""

    files: dict[int, str] = field(default_factory=dict)
    repeated: int = 0

    def add(self, stamp: int, file: str) -> None:
        """Take in an entry; the first of a stamp stays."""
        self.repeated += stamp in self.files
        self.files.setdefault(stamp, file)

    def sort(self) -> None:
        """Put them in order of time."""
        self.files = dict(sorted(self.files.items()))


def read_images(path: Path, damaged: Damaged) -> Images:
    """A list of lines `stamp file`."""
    images = Images()
    for number, words in _lines(path):
        try:
            stamp, file = words
            images.add(_nanoseconds(stamp), file)
        except ValueError:
            damaged.add(number, "expected `stamp file`")
    images.sort()
    return images


def read_associations(path: Path, damaged: Damaged) -> tuple[Images, Images]:
    """(depth, colour) of lines `stamp file stamp file`, in either order: the names tell which."""
    depth, color = Images(), Images()
    for number, words in _lines(path):
        try:
            a, first, b, second = words[:4]
            pairs = [(_nanoseconds(a), first), (_nanoseconds(b), second)]
        except ValueError:
            damaged.add(number, "expected `stamp file stamp file`")
            continue
        pairs.sort(key=lambda pair: "depth" not in pair[1].lower())
        depth.add(*pairs[0])
        color.add(*pairs[1])
    depth.sort()
    color.sort()
    return depth, color


def read_poses(path: Path, damaged: Damaged) -> Track:
    """A trajectory of lines `stamp tx ty tz qx qy qz qw` (s, m), in any order."""
    track = Track()
    for number, words in _lines(path):
        try:
            stamp = _nanoseconds(words[0])
            x, y, z, qx, qy, qz, qw = map(float, words[1:8])
        except ValueError:
            damaged.add(number, "expected `stamp tx ty tz qx qy qz qw`")
            continue
        before = len(track)
        track.add(stamp, (x, y, z), (qx, qy, qz, qw))
        if len(track) == before:
            damaged.add(number, "no pose: not finite, or a quaternion of zeros")
    return track


def _lines(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Number and words of each line that says something; commas part words as spaces do."""
    try:
        with path.open(encoding="utf-8", errors="replace") as file:
            for number, line in enumerate(file, start=1):
                words = line.split("#", 1)[0].replace(",", " ").split()
                if words:
                    yield number, words
    except OSError as error:
        raise SourceError(f"{path}: can't be read: {error.strerror}") from error


def _nanoseconds(text: str) -> int:
    seconds = float(text)
    if not math.isfinite(seconds) or abs(seconds) > 1e10:
        raise ValueError(text)
    return round(seconds * NS)
