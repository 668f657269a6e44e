"""Trajectories as text, a pose a line, as the TUM benchmark and `evo` write them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
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


def read_poses(path: Path, damaged: Damaged) -> Track:
    """A trajectory of lines `stamp tx ty tz qx qy qz qw` (s, m), in any order."""
    track = Track()
    for number, words in lines_of(path):
        try:
            stamp = nanoseconds(words[0])
            x, y, z, qx, qy, qz, qw = map(float, words[1:8])
        except ValueError:
            damaged.add(number, "expected `stamp tx ty tz qx qy qz qw`")
            continue
        before = len(track)
        track.add(stamp, (x, y, z), (qx, qy, qz, qw))
        if len(track) == before:
            damaged.add(number, "no pose: not finite, or a quaternion of zeros")
    return track


def lines_of(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Number and words of each line that says something; commas part words as spaces do."""
    try:
        with path.open(encoding="utf-8", errors="replace") as file:
            for number, line in enumerate(file, start=1):
                words = line.split("#", 1)[0].replace(",", " ").split()
                if words:
                    yield number, words
    except OSError as error:
        raise SourceError(f"{path}: can't be read: {error.strerror}") from error


def nanoseconds(text: str) -> int:
    """Stamp (ns) of seconds in words; `ValueError` where it is no time."""
    seconds = float(text)
    if not math.isfinite(seconds) or abs(seconds) > 9.2e9:
        raise ValueError(text)
    return round(seconds * NS)
