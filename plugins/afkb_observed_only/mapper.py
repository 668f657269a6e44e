"""What a traditional topological map would hold: the paper's comparison in §III, Fig. 2 row 1."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, Hypothesis, TopologicalMap, View
from afkb.inference import Network
from afkb_mapping.bounds import BoundMerger
from afkb_mapping.doorways.merger import DoorwayMerger, passage_width
from afkb_mapping.grid.input import insert_view
from afkb_mapping.grid.occupancy import GridBuilder
from afkb_mapping.ids import Ids
from afkb_mapping.places import Places
from afkb_mapping.snapshot import MapContent, snapshot
from afkb_mapping.things.association import Association


class ObservedOnlyMapper:
    """Places, observed things and bounds; hypotheses are left aside, nothing ever vanishes."""

    works_from_memory = True

    def __init__(self, network: Network) -> None:
        self._network = network
        new_id = Ids()
        self._association = Association(new_id)
        self._places = Places(new_id)
        self._bounds = BoundMerger()
        self._doorways = DoorwayMerger(passage_width(network.knowledge_base))
        self._grid = GridBuilder()
        self._trajectory: list[tuple[float, NDArray[np.float64]]] = []
        self._looked_from: list[NDArray[np.float64]] = []

    def add(
        self, view: View, detections: Sequence[Detection], hypotheses: Sequence[Hypothesis]
    ) -> None:
        """Take in what was seen in one placed view."""
        assert view.T_map_base is not None
        insert_view(self._grid, view)
        self._trajectory.append((view.stamp, view.T_map_base))
        if view.depth_m is not None:
            self._looked_from.append(view.T_map_base[:2, 3])
        seen = [t for t in self._association.match(view, detections) if t is not None]
        in_view = {t.id: None for t in seen if not t.is_floor}
        place = self._places.visit(view, in_view, self._grid)
        for track in seen:
            track.places[place.id] = None
        self._doorways.add(view, detections)
        for detection in detections:
            if detection.segment_xy is not None:
                self._bounds.add(detection, place.id, view.stamp)

    def finish(self, T_map_source: NDArray[np.float64]) -> TopologicalMap:
        """The map of what was added so far."""
        content = MapContent(
            network=self._network,
            tracks=self._association.tracks,
            predictions=(),
            places=self._places.places,
            ways=dict(self._places.ways),
            bounds=self._bounds.bounds(),
            doorways=self._doorways,
            grid=self._grid.grid(),
            closures=(),
            trajectory=self._trajectory,
            looked_from=self._looked_from,
            counts={"births": self._association.births, "merges": self._association.merges},
        )
        return snapshot(content, T_map_source)
