"""A map read back from its folder is the map that was written."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from afkb.errors import MapError
from afkb.flow import (
    Bound,
    Change,
    ChangeKind,
    Edge,
    EdgeKind,
    Entity,
    NodeKind,
    PredictionState,
    Region,
    Relation,
    RobotPlace,
    Room,
    Sighting,
    TopologicalMap,
)
from afkb.store import StoredMap, load, write_map
from afkb.store.reading import read_graph
from afkb.store.scene import scene_triples
from afkb.store.scribe import AFN
from afkb.store.stored import read_scene
from afkb.store.stored_map import read_map
from afkb.store.turtle import to_turtle
from afkb_nav2.exporter import Nav2Exporter
from store_samples import Names, sample_map

BASE = "https://w3id.org/afkb/scene/sample#"
LISTS = {"seen_from", "generated_by", "predicted_from", "axioms", "rooms", "connected_to", "by"}
LISTS |= {"detectors", "notes"}
"""What has no order in RDF."""


def stored(whole: TopologicalMap) -> StoredMap:
    turtle = to_turtle(scene_triples(whole, BASE, Names()), BASE)
    return StoredMap(Path("sample"), read_scene(turtle))


def alike(a: Any, b: Any, where: str = "map") -> None:
    """Fail unless both are equal as far as a scene tells: see `afkb.store.reading`."""
    if is_dataclass(a):
        for field in fields(a):
            one, other = getattr(a, field.name), getattr(b, field.name)
            if field.name in LISTS:
                one, other = sorted(one), sorted(other)
            alike(one, other, f"{where}.{field.name}")
    elif isinstance(a, Mapping):
        assert set(a) == set(b), where
        for key in a:
            alike(a[key], b[key], f"{where}[{key}]")
    elif isinstance(a, np.ndarray):
        np.testing.assert_allclose(a, b, atol=6e-5, err_msg=where)
    elif isinstance(a, tuple | list):
        assert len(a) == len(b), where
        for number, (one, other) in enumerate(zip(a, b, strict=True)):
            alike(one, other, f"{where}[{number}]")
    elif isinstance(a, float) or isinstance(b, float):
        assert math.isclose(a, b, abs_tol=6e-5), f"{where}: {a} and {b}"
    else:
        assert a == b, where


NUMBER = st.floats(-50, 50)
SIZE = st.floats(0, 5)
P = st.floats(0, 1)
STAMP = st.floats(0, 1e5)
IDS = st.text(st.characters(codec="utf-8", exclude_categories=("C", "Z")), min_size=1, max_size=8)
FEATURE = st.sampled_from(["SupportAbility", "ContainAbility", "Hover ability, 2", "Table", "Mug"])
BELIEF = st.dictionaries(FEATURE, P, min_size=1)
SOME = st.lists(st.sampled_from(["p1", "n1", "n2", "a b/c"]), unique=True).map(tuple)
PIXEL = st.integers(0, 640)

SIGHTING = st.builds(
    Sighting,
    view=st.integers(0, 9999),
    stamp=STAMP,
    detectors=st.just(("things", "surfaces")),
    n_pixels=st.integers(1, 10**6),
    range_m=SIZE,
    image_box=st.none() | st.tuples(PIXEL, PIXEL, PIXEL, PIXEL),
    affordances=BELIEF,
)
CHANGE = st.builds(
    Change,
    kind=st.sampled_from(list(ChangeKind)),
    evidence=st.floats(0, 10),
    before=st.none() | P,
    after=P,
    stamp=STAMP,
    view=st.none() | st.integers(0, 9999),
    by=SOME,
)
REGION = st.builds(
    Region,
    relation=st.sampled_from(list(Relation)),
    parts=st.lists(st.tuples(NUMBER, NUMBER, P), min_size=1, max_size=3).map(np.array),
    part_m=st.floats(0.01, 1),
    tops_m=st.tuples(SIZE, SIZE),
)
OUTLINE = st.none() | st.just(np.array([[0.0, 0.0], [1.5, 0.25], [0.3, 1.0]]))


@st.composite
def entities(draw: st.DrawFn) -> tuple[Entity, ...]:
    ids = draw(st.lists(IDS, unique=True, max_size=2))
    return tuple(
        Entity(
            id=id_,
            kind=draw(st.sampled_from(list(NodeKind)[1:])),
            position_xyz=(draw(NUMBER), draw(NUMBER), draw(SIZE)),
            size_xyz=(draw(SIZE), draw(SIZE), draw(SIZE)),
            yaw=draw(NUMBER),
            affordances=draw(BELIEF),
            existence=draw(P),
            category_belief=draw(BELIEF),
            movability=draw(st.sampled_from(["Static", "Dynamic"])),
            matching_weight=draw(P),
            observations=draw(st.integers(0, 999)),
            first_seen=draw(STAMP),
            last_seen=draw(STAMP),
            seen_from=draw(SOME),
            generated_by=("surfaces", "my own/detector"),
            supported_by=draw(st.none() | st.just("n1")),
            part_of=draw(st.none() | st.just("n2")),
            room=draw(st.none() | st.just("room1")),
            predicted_from=draw(SOME),
            predicted_first=draw(st.none() | st.sampled_from(list(NodeKind)[2:])),
            axioms=draw(st.sampled_from([(), (AFN + "a-dual", "named here")])),
            extent_known=draw(st.booleans()),
            polygon_xy=draw(OUTLINE),
            sightings=tuple(draw(st.lists(SIGHTING, max_size=1))),
            history=tuple(draw(st.lists(CHANGE, max_size=2))),
            region=draw(st.none() | REGION),
            state=draw(st.none() | st.sampled_from(list(PredictionState))),
        )
        for id_ in ids
    )


@settings(max_examples=20, deadline=None)
@given(entities())
def test_things_are_read_back_as_they_were_written(things: tuple[Entity, ...]) -> None:
    read = read_graph(stored(replace(sample_map(), entities=things))).entities
    assert {e.id for e in read} == {e.id for e in things}
    by_id = {e.id: e for e in read}
    for thing in things:
        alike(thing, by_id[thing.id])


PLACE = st.builds(RobotPlace, st.just("p"), NUMBER, NUMBER, NUMBER, STAMP, st.integers(0, 999))
XY = st.tuples(NUMBER, NUMBER)
BOUND = st.builds(
    Bound,
    *(st.just("b"), XY, XY, st.integers(0, 999), st.just(("laser", "depth"))),
    room=st.none() | st.just("room1"),
    sigmas=st.none() | st.tuples(SIZE, SIZE),
    existence=P,
    first_seen=STAMP,
    last_seen=STAMP,
)
ROOM = st.builds(
    Room,
    *(st.just("r"), NUMBER, NUMBER, SIZE, OUTLINE.filter(lambda o: o is not None), BELIEF),
    visited=st.booleans(),
    connected_to=SOME,
    evidence=st.dictionaries(FEATURE, st.integers(0, 9)),
    other_beliefs=st.dictionaries(st.sampled_from(["shape", "a-b c"]), BELIEF),
    second_purpose=st.none() | st.tuples(FEATURE, P),
)
EDGE = st.builds(
    Edge,
    *(IDS, st.sampled_from(list(EdgeKind)), st.just("p"), st.just("b"), SIZE, NUMBER),
    linkage_angle=st.none() | NUMBER,
)


@settings(max_examples=20, deadline=None)
@given(PLACE, BOUND, ROOM, EDGE)
def test_places_bounds_rooms_and_edges_are_read_back(
    place: RobotPlace, bound: Bound, room: Room, edge: Edge
) -> None:
    whole = replace(
        sample_map(), places=(place,), bounds=(bound,), rooms=(room,), edges=(edge,), doorways=()
    )
    read = read_graph(stored(whole))
    alike(whole.places, read.places)
    alike(whole.bounds, read.bounds)
    alike(whole.edges, read.edges)
    alike(whole.rooms, read.rooms)


def test_what_has_an_order_keeps_it() -> None:
    """More than ten of a kind: the tenth comes after the ninth, not after the first."""
    table = sample_map().entities[0]
    seen = Sighting(0, 0.0, ("surfaces",), 9, 1.0, None, {"SupportAbility": 0.5})
    step = Change(ChangeKind.SIGHTED, 2.0, None, 0.5, 0.0)
    parts = np.array([[x, 0.0, 1 / 16] for x in range(16)])
    long = replace(
        table,
        sightings=tuple(replace(seen, view=view) for view in range(16)),
        history=tuple(replace(step, view=view) for view in range(16)),
        region=Region(Relation.NEAR, parts, 0.5, (0.5, 1.0)),
    )
    (read,) = read_graph(stored(replace(sample_map(), entities=(long,)))).entities
    alike(long, read)


def test_a_whole_map_is_read_back_with_its_grid_and_its_way(tmp_path: Path) -> None:
    whole = replace(sample_map(), loops=())
    way = "\n".join(" ".join(map(repr, row.tolist())) for row in whole.trajectory)
    state = {"trajectory.txt": way.encode()}
    folder = write_map(tmp_path / "m", whole, {}, [Nav2Exporter()], Names(), state=state)
    read = read_map(load(folder))
    for name in ("places", "doorways", "bounds", "edges", "T_map_source", "trajectory", "counts"):
        alike(getattr(whole, name), getattr(read, name), name)
    alike(sorted(whole.entities, key=lambda e: (e.kind, e.id)), sorted_entities(read))
    assert read.notes == whole.notes
    alike(replace(whole.closures[0], predicted_stamp=1.5), read.closures[0])
    (past,) = read.past_predictions
    alike(whole.past_predictions[0], past)
    np.testing.assert_allclose(read.grid.probability, whole.grid.probability, atol=1 / 255)
    assert read.grid.origin_xy == whole.grid.origin_xy


def sorted_entities(whole: TopologicalMap) -> list[Entity]:
    return sorted(whole.entities, key=lambda e: (e.kind, e.id))


def test_what_is_read_back_makes_the_same_scene(tmp_path: Path) -> None:
    whole = replace(sample_map(), loops=())
    folder = write_map(tmp_path / "m", whole, {}, [Nav2Exporter()], Names())
    first = load(folder)
    again = scene_triples(read_map(first), first.base, Names())
    assert {str(t) for t in again} == {str(q.triple) for q in first.store}


def test_a_value_that_no_map_has_is_told_in_one_line(tmp_path: Path) -> None:
    folder = write_map(tmp_path / "m", sample_map(), {}, [Nav2Exporter()], Names())
    scene = folder / "scene.ttl"
    scene.write_text(scene.read_text().replace('edgeKind "path"', 'edgeKind "rope"'))
    with pytest.raises(MapError, match="'rope'"):
        read_map(load(folder))


def test_a_way_that_is_none_is_told_with_its_file(tmp_path: Path) -> None:
    state = {"trajectory.txt": b"1 2 3\n"}
    folder = write_map(tmp_path / "m", sample_map(), {}, [Nav2Exporter()], Names(), state=state)
    with pytest.raises(MapError, match=r"trajectory\.txt"):
        read_map(load(folder))
