"""The map as it stands: tracks become entities, cells rooms, and the graph gets its edges."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
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
from afkb.inference.recognition import CountsOf
from afkb_mapping.doorways.merger import DoorwayMerger, SeenDoorway
from afkb_mapping.edges import edges_of
from afkb_mapping.grid.occupancy import rasterised
from afkb_mapping.places import Place
from afkb_mapping.predictions.endings import Ended, past_predictions
from afkb_mapping.predictions.entities import predicted_entities, supports_expected
from afkb_mapping.predictions.predicted_track import PredictedTrack
from afkb_mapping.rooms.evidence import RoomEvidence
from afkb_mapping.rooms.graph import connections, doorways_of
from afkb_mapping.rooms.lookup import RoomLookup, room_id
from afkb_mapping.rooms.rooms import Segmentation, divide_by_purpose, segment_rooms
from afkb_mapping.rooms.two_purposes import second_purpose
from afkb_mapping.things.entities import doubtful_entities, observed_entities
from afkb_mapping.things.recognition import recognised
from afkb_mapping.things.tracks import ObservedTrack
from afkb_mapping.visits.bounds_now import bound_now, doorway_now
from afkb_mapping.way_lengths import way_lengths

STEP_M = 0.05
"""What is lower than this, a carpet or a sill, a robot drives over."""


@dataclass(frozen=True, slots=True, eq=False)
class MapContent:
    """What a mapper knows when it is asked for the map.

    `trajectory`: stamp (s) and T_map_base (4, 4) of every view; `looked_from`: (2,) m, where the
    base stood when depth was taken; `ways`: from place to place, with how far the robot went, m.
    `ended`: predictions that are past; `id_now`: of a thing that may have become part of another.
    """

    network: Network
    tracks: Sequence[ObservedTrack]
    predictions: Sequence[PredictedTrack]
    places: Sequence[Place]
    ways: Mapping[tuple[str, str], float]
    bounds: Sequence[Bound]
    doorways: DoorwayMerger
    grid: OccupancyGrid
    closures: Sequence[Closure]
    trajectory: Sequence[tuple[float, NDArray[np.float64]]]
    looked_from: Sequence[NDArray[np.float64]]
    counts: Mapping[str, int]
    ended: Sequence[Ended] = ()
    id_now: Callable[[str], str] = str


def snapshot(content: MapContent, T_map_source: NDArray[np.float64]) -> TopologicalMap:
    """The `TopologicalMap` of a mapper's content."""
    seen_doorways = content.doorways.doorways(content.grid)
    observed = observed_entities(content.tracks, content.network)
    known = {e.id for e in observed}
    entities = [*observed, *_expected(content, known)]
    segmentation, evidence = _parted(content, entities, seen_doorways)
    lookup = RoomLookup(segmentation, content.grid)
    entities += doubtful_entities(content.tracks, content.network)
    supports = supports_expected(content.predictions, content.tracks)
    entities = [
        replace(
            e,
            room=lookup.room_at(*e.position_xyz[:2]),
            supported_by=e.supported_by or supports.get(e.id),
        )
        for e in entities
    ]
    entities = recognised(entities, _counts_by_room(segmentation, evidence), content.network)
    observed = [e for e in entities if e.kind is NodeKind.OBSERVED]
    known = {e.id for e in observed}
    places = [_robot_place(p, lookup) for p in content.places]
    now = max((stamp for stamp, _ in content.trajectory), default=0.0)
    standing = [bound_now(b, content.grid, now) for b in content.bounds]
    bounds = [_bound_in_room(b, lookup) for b in standing]
    judge = content.doorways.judge(content.grid)
    found = doorways_of(segmentation, seen_doorways, judge, lookup.room_at)
    doorways = tuple(doorway_now(d, content.grid) for d in found)
    seen = {p.id: [i for i in p.seen if i in known] for p in content.places}
    ways = list(way_lengths(content.grid, places, content.ways))
    return TopologicalMap(
        places=tuple(places),
        entities=tuple(entities),
        bounds=tuple(bounds),
        doorways=doorways,
        rooms=tuple(_rooms(segmentation, lookup, evidence, places, doorways, content)),
        edges=tuple(edges_of(places, ways, entities, seen, bounds)),
        grid=_with_things(content.grid, entities),
        T_map_source=T_map_source,
        trajectory=np.array([[stamp, *T.ravel()] for stamp, T in content.trajectory]),
        closures=tuple(c for c in content.closures if c.entity in known),
        past_predictions=past_predictions(content.ended, known, content.id_now),
        notes=tuple(_notes(observed)),
        counts=dict(content.counts),
    )


def _expected(content: MapContent, known: Collection[str]) -> list[Entity]:
    return predicted_entities(content.predictions, content.network, known, content.id_now)


def _parted(
    content: MapContent, entities: Sequence[Entity], doorways: Sequence[SeenDoorway]
) -> tuple[Segmentation, RoomEvidence]:
    """Rooms by what stands and by doorways, then by what their parts are for."""
    grid = content.grid
    rooms = segment_rooms(grid, doorways)
    evidence = RoomEvidence(content.network, entities, content.looked_from, rooms.labels, grid)
    prior = content.network.room_posterior({})
    return divide_by_purpose(rooms, grid, evidence.purpose, prior), evidence


def _counts_by_room(segmentation: Segmentation, evidence: RoomEvidence) -> CountsOf:
    """What is counted in each room, by the room's id; nothing in no room."""
    labels = segmentation.labels
    counts = {room_id(r.label): evidence.counts(labels == r.label) for r in segmentation.rooms}
    return lambda room: counts.get(room or "", {})


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


def _rooms(
    segmentation: Segmentation,
    lookup: RoomLookup,
    evidence: RoomEvidence,
    places: Sequence[RobotPlace],
    doorways: Sequence[Doorway],
    content: MapContent,
) -> Iterator[Room]:
    """Rooms with the posterior that the affordances in them give (paper §II.F)."""
    beside = connections(segmentation, doorways)
    visited = {p.room for p in places}
    visited |= {lookup.nearest_room(T[0, 3], T[1, 3]) for _, T in content.trajectory}
    prior = content.network.room_posterior({})
    for shape in segmentation.rooms:
        id_ = room_id(shape.label)
        part = segmentation.labels == shape.label
        at = (id_, *shape.inside_xy, shape.area, shape.polygon_xy)
        seen = id_ in visited, beside.get(id_, ())
        yield Room(
            *at,
            evidence.posterior(part),
            *seen,
            evidence=evidence.counts(part),
            second_purpose=second_purpose(part, content.grid, evidence.purpose, prior),
        )


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
