"""Decides which detections are of one thing: v_ao ~ v_ao over views (paper Algorithm 1)."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from afkb.flow import Detection, View
from afkb.inference import Network
from afkb_mapping.structure import is_structure
from afkb_mapping.things.footprint import Footprint
from afkb_mapping.things.same_kind import same_kind
from afkb_mapping.things.same_thing import (
    FAR_M,
    SURFACE_GAP_M,
    SURFACE_OVERLAP,
    THING_REACH_M,
    around,
    continues,
    distances,
    gate,
    is_floor,
    is_surface,
    may_touch,
    same_height,
    same_surface,
    same_thing,
)
from afkb_mapping.things.track_index import TrackIndex
from afkb_mapping.things.tracks import SURFACE_CELL_M, THING_CELL_M, ObservedTrack


class Association:
    """Keeps the observed tracks, and matches each view's detections to them.

    `births`, `merges` and `splits` count tracks that began, that turned out to be of one thing, and
    that turned out to be of two. With a `network`, no track is of a thing of another kind.
    """

    def __init__(self, new_id: Callable[[str], str], network: Network | None = None) -> None:
        self.tracks = TrackIndex()
        self.births = self.merges = self.splits = 0
        self._new_id, self._network = new_id, network
        self._merged_into: dict[str, str] = {}

    def match(self, view: View, detections: Sequence[Detection]) -> list[ObservedTrack | None]:
        """The track of each detection (new where it is new); None for what is no thing."""
        found: list[ObservedTrack | None] = [None] * len(detections)
        things = []
        for i, detection in enumerate(detections):
            if is_structure(detection):
                continue
            if is_surface(detection):
                found[i] = self._see(view, detection, self._surface_track(detection))
            else:
                things.append(i)
        matched = self._thing_tracks([detections[i] for i in things])
        for i, track in zip(things, matched, strict=True):
            found[i] = self._see(view, detections[i], track)
        return [self._survivor(t) for t in found]

    def id_now(self, id_: str) -> str:
        """The id that a track goes by, once others have taken it over."""
        while (taken_over := self._merged_into.get(id_)) is not None:
            id_ = taken_over
        return id_

    def _survivor(self, track: ObservedTrack | None) -> ObservedTrack | None:
        """A track that was merged away during this view lives on in the one that took it over."""
        if track is None or track in self.tracks:
            return track
        return self.tracks[self.id_now(track.id)]

    def _see(self, view: View, detection: Detection, track: ObservedTrack | None) -> ObservedTrack:
        if track is None:
            track = self._birth(detection)
        eye = view.T_map_camera if view.depth_m is not None else view.T_map_laser
        track.see(detection, view.index, view.stamp, eye[:2, 3])
        self.tracks.moved(track)
        return track

    def _birth(self, detection: Detection) -> ObservedTrack:
        kind = "thing"
        if is_surface(detection):
            kind = "floor" if is_floor(detection) else "surface"
        track = ObservedTrack(
            id=self._new_id(kind),
            is_surface=kind != "thing",
            footprint=Footprint(THING_CELL_M if kind == "thing" else SURFACE_CELL_M),
            is_floor=kind == "floor",
        )
        self.tracks.add(track)
        self.births += 1
        return track

    def _surface_track(self, detection: Detection) -> ObservedTrack | None:
        if is_floor(detection):
            return self.tracks.floor
        near = []
        if not len(detection.footprint_xy):
            return None
        for track in self.tracks.near(
            *around(detection.footprint_xy, SURFACE_GAP_M + SURFACE_CELL_M)
        ):
            if track.is_surface and same_height(track, detection):
                share = track.footprint.overlap(detection.footprint_xy)
                if share >= SURFACE_OVERLAP or continues(track, detection):
                    near.append((share, track))
        near.sort(key=lambda pair: (-pair[0], pair[1].id))
        return self._merged([track for _, track in near])

    def _merged(self, tracks: Sequence[ObservedTrack]) -> ObservedTrack | None:
        """One track of several that a new view has bridged: the oldest takes over the others."""
        if not tracks:
            return None
        keeper = min(tracks, key=self.tracks.rank)
        for other in tracks:
            if other is not keeper:
                self._absorb(keeper, other)
        return keeper

    def _absorb(self, keeper: ObservedTrack, other: ObservedTrack) -> None:
        keeper.absorb(other)
        self.tracks.moved(keeper)
        self.tracks.remove(other)
        self._merged_into[other.id] = keeper.id
        self.merges += 1

    def _thing_tracks(self, detections: Sequence[Detection]) -> list[ObservedTrack | None]:
        """Best one-to-one matching of one view's things to the known ones (Hungarian method)."""
        tracks = self._things_near(detections)
        if not tracks:
            return [None] * len(detections)
        middles = np.array([t.footprint.middle() for t in tracks])
        cost = np.array([distances(tracks, middles, d) for d in detections])
        if self._network is not None:
            for row, column in np.argwhere(cost < FAR_M).tolist():
                if not same_kind(tracks[column], detections[row], self._network):
                    cost[row, column] = FAR_M
        rows, columns = linear_sum_assignment(cost)
        found: list[ObservedTrack | None] = [None] * len(detections)
        for row, column in zip(rows, columns, strict=True):
            if cost[row, column] < FAR_M:
                found[row] = tracks[column]
        self._split(detections, found, tracks, cost)
        return found

    def _split(
        self,
        detections: Sequence[Detection],
        found: Sequence[ObservedTrack | None],
        tracks: Sequence[ObservedTrack],
        cost: NDArray[np.float64],
    ) -> None:
        """Part what one view shows to be two things: both lie where one track has been seen."""
        for row, detection in enumerate(detections):
            column = int(cost[row].argmin())
            if found[row] is not None or cost[row, column] >= FAR_M:
                continue
            one = tracks[column]
            if one in found and one.footprint.share_within(detection.footprint_xy, 0.0) > 0.5:
                one.footprint.give_up(detection.footprint_xy)
                self.splits += 1

    def _things_near(self, detections: Sequence[Detection]) -> list[ObservedTrack]:
        """The things among the tracks that one of the detections may be of, in order of birth."""
        near = {
            track: None
            for d in detections
            for track in self.tracks.near(*around(np.array([d.box.center_xyz[:2]]), gate(d)))
            if not track.is_surface
        }
        return sorted(near, key=self.tracks.rank)

    def merge_doubles(self) -> None:
        """Merge tracks that views from different sides have grown into the same place."""
        for same in (same_thing, same_surface):
            for first in self.tracks:
                younger = self.tracks.rank(first) if first in self.tracks else None
                while younger is not None:
                    younger = self._absorb_double(first, younger, same)

    def _absorb_double(
        self,
        first: ObservedTrack,
        younger_than: int,
        same: Callable[[ObservedTrack, ObservedTrack], bool],
    ) -> int | None:
        """Merge the next track that is the same as `first` into it: its rank, or None."""
        extent = first.footprint.extent()
        if first.is_surface is not (same is same_surface) or extent is None:
            return None
        for second in self.tracks.near(*around(np.array(extent), THING_REACH_M)):
            rank = self.tracks.rank(second)
            if rank <= younger_than or second.is_surface is not first.is_surface:
                continue
            if may_touch(first, second) and same(first, second):
                self._absorb(first, second)
                return rank
        return None
