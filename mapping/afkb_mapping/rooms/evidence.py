"""What is in a part of the map, and what that tells of its purpose (paper §II.F)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from afkb.flow import Entity, NodeKind, OccupancyGrid
from afkb.inference import Network
from afkb.inference.recognition import evidence_of
from afkb_mapping.rooms.lookup import REACH_M

Mask = NDArray[np.bool_]
Labels = NDArray[np.int32]

SEEN_RELIABLY = ("SupportAbility",)
"""Features whose absence from a visited room says something: their detectors overlook little."""


class RoomEvidence:
    """Observed things and viewpoints by the cell of a room that is nearest to them.

    `labels` (rows, cols): rooms, 0 = none. `looked_from`: (2,) m, where the base stood when depth
    was taken.
    """

    def __init__(
        self,
        network: Network,
        entities: Iterable[Entity],
        looked_from: Sequence[NDArray[np.float64]],
        labels: Labels,
        grid: OccupancyGrid,
    ) -> None:
        self._network = network
        observed = [e for e in entities if e.kind is NodeKind.OBSERVED]
        things = np.array([e.position_xyz[:2] for e in observed], dtype=np.float64).reshape(-1, 2)
        eyes = np.array(looked_from, dtype=np.float64).reshape(-1, 2)
        self._things, off_m = _nearest(things, labels, grid)
        self._eyes, _ = _nearest(eyes, labels, grid)
        self._evidence = [
            evidence_of(e, network) if off <= REACH_M else ()
            for e, off in zip(observed, off_m.tolist(), strict=True)
        ]

    def posterior(self, part: Mask) -> dict[str, float]:
        """Of the purpose of a part (rows, cols) of the rooms.

        Where the robot has looked, that something is not there counts, too.
        """
        return self._network.room_posterior(self.counts(part))

    def purpose(self, part: Mask) -> dict[str, float] | None:
        """The same, but None where nothing that tells of a purpose is in the part."""
        counts = self.counts(part)
        return self._network.room_posterior(counts) if any(counts.values()) else None

    def counts(self, part: Mask) -> Counter[str]:
        """Evidence class to how many things of it the part holds; 0 of what was looked for."""
        counts: Counter[str] = Counter()
        if part[tuple(self._eyes.T)].any():
            counts.update(dict.fromkeys(self._network.evidence_looked_for(SEEN_RELIABLY), 0))
        for inside, evidence in zip(part[tuple(self._things.T)], self._evidence, strict=True):
            if inside:
                counts.update(evidence)
        return counts


def _nearest(
    points_xy: NDArray[np.float64], labels: Labels, grid: OccupancyGrid
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """(N, 2) row and column of the cell of a room nearest to points (N, 2), m, and how far, m.

    Off the grid, infinitely far.
    """
    cells = np.floor((points_xy - np.array(grid.origin_xy)) / grid.resolution_m)[:, ::-1]
    limits = np.array(labels.shape) - 1
    clipped = np.clip(cells, 0, limits).astype(np.intp)
    if not labels.any():
        return clipped, np.full(len(points_xy), np.inf)
    distance, indices = ndimage.distance_transform_edt(labels == 0, return_indices=True)
    rows, cols = clipped.T
    off = np.where((cells == clipped).all(axis=1), distance[rows, cols], np.inf)
    return np.moveaxis(indices, 0, -1)[rows, cols], off * grid.resolution_m
