"""A recording without stated up, and a list of what a person saw in it."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, View
from afkb.plugins.host import PluginHost
from afkb.plugins.protocols import Source
from afkb_mapping.geometry import back_project, transform
from afkb_mapping.placing.levelling import level
from afkb_mapping.run_record import Settings
from afkb_mapping.selection import Selection
from bench.detectors.seen import Run, run_detectors

LABELS = Path(__file__).parents[1] / "labels" / "redkitchen.csv"
EVERY = 10
"""Of 500 frames, fifty: neighbours show the same. Of these there are colour images, too."""
FRAME_NUMBER_STEP = 2
"""Every second frame of the sequence is recorded; lists name frames by their number in it."""
PATCH_PX = 3
"""A labelled place is the median of the depth this many pixels around it."""
BESIDE_M, SUPPORT_BESIDE_M, SUPPORT_HEIGHT_M = 0.03, 0.10, 0.04
"""How near a claim has to be to a labelled place: for bodies their box grown by the first; for
surfaces to a point of their footprint, and in height."""


@dataclass(frozen=True, eq=False)
class Label:
    """One entry of the list: what, whether it is so, and where (M, 3), map frame, m.

    `expect`: `found`, `not`, or `either`. `frames`: (first, last) in which it is in view.
    """

    name: str
    feature: str
    expect: str
    frames: tuple[tuple[int, int], ...]
    places_xyz: NDArray[np.float64]

    def in_view(self, frame: int) -> bool:
        """Whether the list has it in view in a frame."""
        return any(first <= frame <= last for first, last in self.frames)

    def distance(self, claim: Detection) -> float:
        """From its nearest place to the claim's centre, m; inf where no place lies in the claim."""
        places = self.places_xyz
        if "area" in claim.measures:  # of a surface, whatever is told of it
            within = np.array([_on_footprint(p, claim) for p in places], bool)
        else:
            within = np.array([_in_box(p, claim) for p in places], bool)
        if not within.any():
            return float("inf")
        off = places[within] - np.array(claim.box.center_xyz)
        return float(np.linalg.norm(off, axis=1).min())


def _on_footprint(place: NDArray[np.float64], claim: Detection) -> bool:
    apart = np.hypot(*(claim.footprint_xy - place[:2]).T).min()
    height = claim.measures.get("height", claim.box.top)
    return bool(apart <= SUPPORT_BESIDE_M and abs(height - place[2]) <= SUPPORT_HEIGHT_M)


def _in_box(place: NDArray[np.float64], claim: Detection) -> bool:
    x, y, z = place - np.array(claim.box.center_xyz)
    c, s = np.cos(claim.box.yaw), np.sin(claim.box.yaw)
    along = np.abs([c * x + s * y, c * y - s * x, z])
    return bool(np.all(along <= np.array(claim.box.size_xyz) / 2 + BESIDE_M))


@dataclass
class Kitchen:
    """The recording, levelled as a map of it is, and its labels."""

    folder: Path
    host: PluginHost
    stride: int = 1
    detectors: tuple[str, ...] = ()

    @cached_property
    def source(self) -> Source:
        """The recording as it is."""
        return self.host.open_source(str(self.folder))

    @cached_property
    def T_map_source(self) -> NDArray[np.float64]:
        """(4, 4) what makes it level, floor at 0."""
        sample = Selection(self.source, Settings(uri=str(self.folder), out=Path())).sample()
        return level(sample, self.source.gravity_aligned).T_map_source

    def views(self, start: int = 0, stop: int | None = None, stride: int = 0) -> Iterator[View]:
        """Its usable views in the map frame; every tenth unless told."""
        for view in self.source.views(start, stop, stride or EVERY * self.stride):
            if isinstance(view, View):
                yield replace(view, T_map_base=self.T_map_source @ view.T_odom_base)

    @cached_property
    def seen(self) -> Run:
        """Every detection in it, by view."""
        return run_detectors(self.views(), self.host.detectors(self.detectors))

    @cached_property
    def labels(self) -> list[Label]:
        """The list with its places in the map frame; entries whose places have no depth go."""
        with LABELS.open(encoding="utf-8") as file:
            found = [self._label(row) for row in csv.DictReader(file)]
        return [label for label in found if len(label.places_xyz)]

    def _label(self, row: dict[str, str]) -> Label:
        spans = [part.split("-") for part in row["frames"].split(";")]
        places = [self._place(*map(int, at.split(":"))) for at in row["pixels"].split(";")]
        return Label(
            row["id"],
            row["feature"],
            row["expect"],
            tuple((int(first), int(last)) for first, last in spans),
            np.array([p for p in places if p is not None]).reshape(-1, 3),
        )

    def _place(self, frame: int, u: int, v: int) -> NDArray[np.float64] | None:
        index = frame // FRAME_NUMBER_STEP
        view = next(self.views(index, index + 1, 1), None)
        if view is None or view.depth_m is None or view.camera is None:
            return None
        rows, columns = slice(v - PATCH_PX, v + PATCH_PX + 1), slice(u - PATCH_PX, u + PATCH_PX + 1)
        patch = back_project(view.depth_m, view.camera, 1)[rows, columns].reshape(-1, 3)
        seen = patch[patch[:, 2] > 0]
        if not len(seen):
            return None
        place: NDArray[np.float64] = np.median(seen.astype(np.float64), axis=0)
        return transform(view.T_map_camera, place[None])[0]


def frame_number(view_index: int) -> int:
    """The number in the list of a view of the recording."""
    return view_index * FRAME_NUMBER_STEP


def label_of(claim: Detection, feature: str, frame: int, labels: list[Label]) -> Label | None:
    """The label of a feature that a claim is nearest to, of those it holds."""
    near = [(entry.distance(claim), entry) for entry in labels if entry.feature == feature]
    distance, best = min(near, key=lambda pair: pair[0], default=(float("inf"), None))
    return best if np.isfinite(distance) else None
