"""What is seen, by where it is and in order of discovery."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.box_index import BoxIndex
from afkb_mapping.things.tracks import SURFACE_CELL_M, ObservedTrack

Array = NDArray[np.float64]

STANDS_REACH_M = 3 * SURFACE_CELL_M
"""What carries a thing lies below it, within the cells that `support_of` allows."""


class TrackIndex:
    """The observed tracks in order of birth; those but the floor also by place."""

    def __init__(self) -> None:
        self._tracks: dict[str, ObservedTrack] = {}
        self._ranks: dict[str, int] = {}
        self._boxes: BoxIndex[ObservedTrack] = BoxIndex()
        self._floors: dict[str, ObservedTrack] = {}
        self._born = 0

    @classmethod
    def of(cls, tracks: Iterable[ObservedTrack]) -> TrackIndex:
        """An index of tracks that have their places."""
        index = cls()
        for track in tracks:
            index.add(track)
            index.moved(track)
        return index

    def __len__(self) -> int:
        return len(self._tracks)

    def __iter__(self) -> Iterator[ObservedTrack]:
        return iter(list(self._tracks.values()))

    def __contains__(self, track: ObservedTrack) -> bool:
        return self._tracks.get(track.id) is track

    def __getitem__(self, id_: str) -> ObservedTrack:
        return self._tracks[id_]

    @property
    def floor(self) -> ObservedTrack | None:
        """The floor that was seen first, or None."""
        return next(iter(self._floors.values()), None)

    def rank(self, track: ObservedTrack) -> int:
        """Its number in order of birth: less than that of every younger one."""
        return self._ranks[track.id]

    def add(self, track: ObservedTrack) -> None:
        """Take in a new track; it has no place before `moved` is told of one."""
        self._tracks[track.id] = track
        self._ranks[track.id] = self._born
        self._born += 1
        if track.is_floor:
            self._floors[track.id] = track

    def moved(self, track: ObservedTrack) -> None:
        """Note where a track is now: to be called whenever its footprint has changed."""
        extent = track.footprint.extent()
        if extent is not None and not track.is_floor:
            self._boxes.put(track, *extent)

    def remove(self, track: ObservedTrack) -> None:
        """Take a track out; `KeyError` if it is not there."""
        del self._tracks[track.id], self._ranks[track.id]
        self._floors.pop(track.id, None)
        if track in self._boxes:
            self._boxes.remove(track)

    def near(self, low_xy: Array, high_xy: Array) -> list[ObservedTrack]:
        """Tracks but the floor that may have a part in a box, m, in order of birth."""
        return sorted(self._boxes.near(low_xy, high_xy), key=lambda t: self._ranks[t.id])

    def carriers(self, track: ObservedTrack) -> list[ObservedTrack]:
        """Surfaces that may carry a track: those under it in order of birth, then the floor."""
        points = track.footprint.points()
        near = self.near(points.min(axis=0) - STANDS_REACH_M, points.max(axis=0) + STANDS_REACH_M)
        surfaces = [t for t in near if t.is_surface]
        return surfaces if self.floor is None else [*surfaces, self.floor]
