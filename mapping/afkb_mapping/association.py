"""Decides which detections are of one thing: v_ao ~ v_ao over views (paper Algorithm 1)."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from afkb.flow import Detection, View
from afkb_mapping.footprint import Footprint
from afkb_mapping.structure import is_structure
from afkb_mapping.tracks import SURFACE_CELL_M, THING_CELL_M, ObservedTrack

SURFACE_OVERLAP = 0.05
"""Two views of one surface share at least this part of the smaller one's cells; neighbouring
pieces of furniture share none, however small the gap."""
SURFACE_GAP_M = 0.08
"""Where the image edge cuts a surface, its other part may begin this far on."""
SURFACE_HEIGHT_M = 0.015
"""Parts of one surface agree in height within this and the measurement's standard deviation."""
SOFT_HEIGHT_M, SOFT_OVERLAP = 0.06, 0.5
"""Nothing supports right under another surface: what lies on top of each other, this near, is one
soft or hollow seat, or a tray on its table."""
THING_REACH_M = 0.06
THING_HEIGHT_M = 0.06
SAME_EXTENT = 2.5
"""One view of a thing shows at most so many times the length that another shows: more is something
that it stands on or beside."""
FOOTPRINT_SPACING_M = 0.02
"""How far apart a detection's footprint points lie, by its contract."""
FAR_M = 1e3


class Association:
    """Keeps the observed tracks, and matches each view's detections to them."""

    def __init__(self, new_id: Callable[[str], str]) -> None:
        self.tracks: list[ObservedTrack] = []
        self.births = self.merges = 0
        self._new_id = new_id
        self._merged_into: dict[str, str] = {}

    def match(self, view: View, detections: Sequence[Detection]) -> list[ObservedTrack | None]:
        """The track of each detection (new where it is new); None for what is no thing."""
        found: list[ObservedTrack | None] = [None] * len(detections)
        things = []
        for i, detection in enumerate(detections):
            if is_structure(detection):
                continue
            if _is_surface(detection):
                found[i] = self._see(view, detection, self._surface_track(detection))
            else:
                things.append(i)
        matched = self._thing_tracks([detections[i] for i in things])
        for i, track in zip(things, matched, strict=True):
            found[i] = self._see(view, detections[i], track)
        return [self._survivor(t) for t in found]

    def id_now(self, id_: str) -> str:
        """The id that a track goes by, once others have taken it over."""
        return self._merged_into.get(id_, id_)

    def _survivor(self, track: ObservedTrack | None) -> ObservedTrack | None:
        """A track that was merged away during this view lives on in the one that took it over."""
        if track is None or track in self.tracks:
            return track
        return next(t for t in self.tracks if t.id == self.id_now(track.id))

    def _see(self, view: View, detection: Detection, track: ObservedTrack | None) -> ObservedTrack:
        if track is None:
            track = self._birth(detection)
        eye = view.T_map_camera if view.depth_m is not None else view.T_map_laser
        track.see(detection, view.index, view.stamp, eye[:2, 3])
        return track

    def _birth(self, detection: Detection) -> ObservedTrack:
        kind = "thing"
        if _is_surface(detection):
            kind = "floor" if _is_floor(detection) else "surface"
        track = ObservedTrack(
            id=self._new_id(kind),
            is_surface=kind != "thing",
            footprint=Footprint(THING_CELL_M if kind == "thing" else SURFACE_CELL_M),
            is_floor=kind == "floor",
        )
        self.tracks.append(track)
        self.births += 1
        return track

    def _surface_track(self, detection: Detection) -> ObservedTrack | None:
        if _is_floor(detection):
            return next((t for t in self.tracks if t.is_floor), None)
        near = []
        for track in self.tracks:
            if track.is_surface and not track.is_floor and _same_height(track, detection):
                share = track.footprint.overlap(detection.footprint_xy)
                if share >= SURFACE_OVERLAP or _continues(track, detection):
                    near.append((share, track))
        near.sort(key=lambda pair: (-pair[0], pair[1].id))
        return self._merged([track for _, track in near])

    def _merged(self, tracks: Sequence[ObservedTrack]) -> ObservedTrack | None:
        """One track of several that a new view has bridged: the oldest takes over the others."""
        if not tracks:
            return None
        keeper = min(tracks, key=self.tracks.index)
        for other in tracks:
            if other is not keeper:
                self._absorb(keeper, other)
        return keeper

    def _absorb(self, keeper: ObservedTrack, other: ObservedTrack) -> None:
        keeper.absorb(other)
        self.tracks.remove(other)
        for gone, into in list(self._merged_into.items()):
            if into == other.id:
                self._merged_into[gone] = keeper.id
        self._merged_into[other.id] = keeper.id
        self.merges += 1

    def _thing_tracks(self, detections: Sequence[Detection]) -> list[ObservedTrack | None]:
        """Best one-to-one matching of one view's things to the known ones (Hungarian method)."""
        tracks = [t for t in self.tracks if not t.is_surface]
        if not tracks or not detections:
            return [None] * len(detections)
        middles = np.array([t.footprint.middle() for t in tracks])
        cost = np.array([_distances(tracks, middles, d) for d in detections])
        rows, columns = linear_sum_assignment(cost)
        found: list[ObservedTrack | None] = [None] * len(detections)
        for row, column in zip(rows, columns, strict=True):
            if cost[row, column] < FAR_M:
                found[row] = tracks[column]
        return found

    def merge_doubles(self) -> None:
        """Merge tracks that views from different sides have grown into the same place."""
        for same in (_same_thing, _same_surface):
            tracks = [t for t in self.tracks if t.is_surface is (same is _same_surface)]
            for i, first in enumerate(tracks):
                if first.id in self._merged_into:
                    continue
                for second in tracks[i + 1 :]:
                    if second.id in self._merged_into:
                        continue
                    if _may_touch(first, second) and same(first, second):
                        self._absorb(first, second)


def _is_surface(detection: Detection) -> bool:
    """Whether supporting is what it is detected by; a box affords it too, but is a thing."""
    first = (detection.parts or (detection,))[0]
    best = max(first.affordances, key=lambda name: first.affordances[name])
    return best == "SupportAbility"


def _is_floor(detection: Detection) -> bool:
    return bool(detection.measures.get("is_floor", 0.0))


def _same_height(track: ObservedTrack, detection: Detection) -> bool:
    deviation = float(np.sqrt(max(detection.covariance_xyz[2, 2], 0.0)))
    apart = abs(track.top.value - detection.position_xyz[2])
    return bool(apart <= SURFACE_HEIGHT_M + deviation)


def _continues(track: ObservedTrack, detection: Detection) -> bool:
    """Whether a surface that the image edge cuts goes on where the track is."""
    return detection.cut_by_image and (
        track.footprint.share_within(detection.footprint_xy, SURFACE_GAP_M) > 0
    )


def _same_surface(first: ObservedTrack, second: ObservedTrack) -> bool:
    if first.is_floor or second.is_floor:
        return False
    apart = abs(first.top.value - second.top.value)
    if apart > SOFT_HEIGHT_M:
        return False
    wanted = SURFACE_OVERLAP if apart <= SURFACE_HEIGHT_M else SOFT_OVERLAP
    return first.footprint.overlap(second.footprint.points()) >= wanted


def _overlap_in_height(track: ObservedTrack, bottom: float, top: float) -> bool:
    ends_agree = (
        abs(track.top.value - top) < THING_HEIGHT_M
        or abs(track.bottom.value - bottom) < THING_HEIGHT_M
    )
    return (
        ends_agree
        and min(track.top.value, top) > max(track.bottom.value, bottom) - THING_HEIGHT_M / 2
    )


def _distances(
    tracks: Sequence[ObservedTrack], middles: NDArray[np.float64], detection: Detection
) -> NDArray[np.float64]:
    """Distance (m) of each track's middle (N, 2) if both may be one thing, else FAR_M: (N,)."""
    box = detection.box
    apart = np.hypot(*(middles - np.asarray(box.center_xyz[:2])).T)
    # Two solid things can't come nearer to each other than their width.
    width = sum(box.size_xyz[:2]) / 2
    gate = max(THING_REACH_M, width) + 2 * float(np.sqrt(detection.covariance_xyz[0, 0]))
    found = np.full(len(tracks), FAR_M)
    for i in np.flatnonzero(apart <= gate).tolist():
        if not _as_long(tracks[i], detection):
            continue
        if _overlap_in_height(tracks[i], box.bottom, box.top):
            shared = tracks[i].footprint.share_within(detection.footprint_xy, THING_CELL_M)
            found[i] = apart[i] * (1.5 - shared)
    return found


def _as_long(track: ObservedTrack, detection: Detection) -> bool:
    """Whether both may be the length of one thing, as far as views of a part allow."""
    low, high = track.footprint.box()
    known, seen = float(np.hypot(*(high - low))), float(np.hypot(*detection.box.size_xyz[:2]))
    shorter, longer = sorted((known + THING_REACH_M, seen + THING_REACH_M))
    return longer <= SAME_EXTENT * shorter


def _may_touch(first: ObservedTrack, second: ObservedTrack) -> bool:
    """Whether the boxes around two footprints come as near as one thing's parts may."""
    (low, high), (other_low, other_high) = first.footprint.box(), second.footprint.box()
    return all(
        low[k] <= other_high[k] + THING_REACH_M and other_low[k] <= high[k] + THING_REACH_M
        for k in range(2)
    )


def _same_thing(first: ObservedTrack, second: ObservedTrack) -> bool:
    if not _overlap_in_height(first, second.bottom.value, second.top.value):
        return False
    shared = max(
        first.footprint.share_within(second.footprint.points(), FOOTPRINT_SPACING_M),
        second.footprint.share_within(first.footprint.points(), FOOTPRINT_SPACING_M),
    )
    return shared > 0.5
