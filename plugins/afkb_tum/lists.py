"""The benchmark's lists of images: by stamp, or depth and colour side by side."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from afkb_mapping.recordings.pose_file import Damaged, lines_of, nanoseconds


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
    for number, words in lines_of(path):
        try:
            stamp, file = words
            images.add(nanoseconds(stamp), file)
        except ValueError:
            damaged.add(number, "expected `stamp file`")
    images.sort()
    return images


def read_associations(path: Path, damaged: Damaged) -> tuple[Images, Images]:
    """(depth, colour) of lines `stamp file stamp file`, in either order: the names tell which."""
    depth, color = Images(), Images()
    for number, words in lines_of(path):
        try:
            a, first, b, second = words[:4]
            pairs = [(nanoseconds(a), first), (nanoseconds(b), second)]
        except ValueError:
            damaged.add(number, "expected `stamp file stamp file`")
            continue
        pairs.sort(key=lambda pair: "depth" not in pair[1].lower())
        depth.add(*pairs[0])
        color.add(*pairs[1])
    depth.sort()
    color.sort()
    return depth, color
