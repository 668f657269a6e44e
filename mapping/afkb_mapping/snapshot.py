"""The map as it stands: tracks become entities, cells rooms, and the graph gets its edges."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from afkb.flow import (
    Bound,
    Closure,
    Doorway,
    Entity,
    NodeKind,
    OccupancyGrid,
    RobotPlace,
    Room,
    TopologicalMap,
)
from afkb.inference import Network
from afkb_mapping.doorway_merger import SeenDoorway
from afkb_mapping.doorways_united import united
from afkb_mapping.edges import edges_of
from afkb_mapping.entities import observed_entities, predicted_entities, supports_expected
from afkb_mapping.occupancy import rasterised
from afkb_mapping.places import Place
from afkb_mapping.predicted_track import PredictedTrack
from afkb_mapping.room_lookup import RoomLookup, room_id
from afkb_mapping.rooms import Segmentation, segment_rooms
from afkb_mapping.tracks import ObservedTrack
from afkb_mapping.way_lengths import way_lengths

SEEN_RELIABLY = ("SupportAbility",)
"""Features whose absence from a visited room says something: their detectors overlook little."""
STEP_M = 0.05
"""What is lower than this, a carpet or a sill, a robot drives over."""


@dataclass(frozen=True, slots=True, eq=False)
class MapContent:
    """What a mapper knows when it is asked for the map.

    `trajectory`: stamp (s) and T_map_base (4, 4) of every view; `looked_from`: (2,) m, where the
    base stood when depth was taken; `ways`: from place to place, with how far the robot went, m.
    """

    network: Network
    tracks: Sequence[ObservedTrack]
    predictions: Sequence[PredictedTrack]
    places: Sequence[Place]
    ways: Mapping[tuple[str, str], float]
    bounds: Sequence[Bound]
    doorways: Sequence[SeenDoorway]
    grid: OccupancyGrid
    closures: Sequence[Closure]
    trajectory: Sequence[tuple[float, NDArray[np.float64]]]
    looked_from: Sequence[NDArray[np.float64]]
    counts: Mapping[str, int]


def snapshot(content: MapContent, T_map_source: NDArray[np.float64]) -> TopologicalMap:
    """The `TopologicalMap` of a mapper's content."""
    segmentation = segment_rooms(content.grid, content.doorways)
    lookup = RoomLookup(segmentation, content.grid)
    observed = observed_entities(content.tracks, content.network)
    known = {e.id for e in observed}
    entities = [*observed, *predicted_entities(content.predictions, content.network, known)]
    supports = supports_expected(content.predictions, content.tracks)
    entities = [
        replace(
            e,
            room=lookup.room_at(*e.position_xyz[:2]),
            supported_by=e.supported_by or supports.get(e.id),
        )
        for e in entities
    ]
    places = [_robot_place(p, lookup) for p in content.places]
    bounds = [_bound_in_room(b, lookup) for b in content.bounds]
    seen = {p.id: [i for i in p.seen if i in known] for p in content.places}
    ways = list(way_lengths(content.grid, places, content.ways))
    return TopologicalMap(
        places=tuple(places),
        entities=tuple(entities),
        bounds=tuple(bounds),
        doorways=tuple(_doorways(segmentation, content.doorways, lookup)),
        rooms=tuple(_rooms(segmentation, lookup, entities, places, content)),
        edges=tuple(edges_of(places, ways, entities, seen, bounds)),
        grid=_with_things(content.grid, entities),
        T_map_source=T_map_source,
        trajectory=np.array([[stamp, *T.ravel()] for stamp, T in content.trajectory]),
        closures=tuple(c for c in content.closures if c.entity in known),
        notes=tuple(_notes(observed)),
        counts=dict(content.counts),
    )


def _notes(observed: Sequence[Entity]) -> Iterator[str]:
    vague = [e.id for e in observed if not e.extent_known]
    if vague:
        yield (
            f"{', '.join(vague)}: extent not known, the sensor returns too little there "
            "(glossy, black or transparent tops)"
        )


def _robot_place(place: Place, lookup: RoomLookup) -> RobotPlace:
    room = lookup.nearest_room(place.x, place.y)
    return RobotPlace(place.id, place.x, place.y, place.yaw, place.stamp, place.view_index, room)


def _bound_in_room(bound: Bound, lookup: RoomLookup) -> Bound:
    middle = (np.asarray(bound.start_xy) + bound.end_xy) / 2
    return replace(bound, room=lookup.room_at(*middle))


def _doorways(
    segmentation: Segmentation, seen: Sequence[SeenDoorway], lookup: RoomLookup
) -> list[Doorway]:
    return [
        Doorway(f"doorway-{i}", d.x, d.y, d.yaw, d.width, d.rooms)
        for i, d in enumerate(united(segmentation.doorways, seen, lookup.room_at), start=1)
    ]


def _rooms(
    segmentation: Segmentation,
    lookup: RoomLookup,
    entities: Sequence[Entity],
    places: Sequence[RobotPlace],
    content: MapContent,
) -> list[Room]:
    """Rooms with the posterior that the affordances in them give (paper §II.F)."""
    visited = {p.room for p in places}
    visited |= {lookup.nearest_room(T[0, 3], T[1, 3]) for _, T in content.trajectory}
    looked_at = {lookup.nearest_room(*xy) for xy in content.looked_from}
    rooms = []
    for shape in segmentation.rooms:
        id_ = room_id(shape.label)
        counts: Counter[str] = Counter()
        if id_ in looked_at:
            counts.update(dict.fromkeys(content.network.evidence_looked_for(SEEN_RELIABLY), 0))
        for entity in entities:
            if entity.room == id_ and entity.kind is NodeKind.OBSERVED:
                counts.update(_evidence_of(entity, content.network))
        belief = content.network.room_posterior(counts)
        x, y = shape.inside_xy
        rooms.append(Room(id_, x, y, shape.area, shape.polygon_xy, belief, id_ in visited))
    return rooms


def _evidence_of(entity: Entity, network: Network) -> tuple[str, ...]:
    known = network.known(entity.affordances)
    return network.evidence_of(known, entity.size_xyz, entity.top_m)


def _with_things(grid: OccupancyGrid, entities: Sequence[Entity]) -> OccupancyGrid:
    """O(x, y) of Algorithm 1: what isn't a robot place fills its cells, predicted things too.

    With its probability, times its matching weight: dynamic things fill the grid weakly.
    """
    standing = [
        (entity.polygon_xy, entity.existence * entity.matching_weight)
        for entity in entities
        if entity.polygon_xy is not None and _stands_in_the_way(entity)
    ]
    return rasterised(grid, standing)


def _stands_in_the_way(entity: Entity) -> bool:
    """The floor and what lies flat on it do not; things on a support are within its outline."""
    return entity.top_m > STEP_M
