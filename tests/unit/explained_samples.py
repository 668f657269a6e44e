"""A room whose beliefs are those of the network, written as a map folder."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from afkb.flow import Change, ChangeKind, Entity, NodeKind, Region, Relation, Sighting
from afkb.inference import Network, network_of
from afkb.inference.existence import folded
from afkb.knowledge import AfNet
from afkb.store import StoredMap, load, write_map
from afkb.store.made_with import ontology_record
from store_samples import entity, sample_map

TABLE_SEEN = Sighting(
    40, 9.25, ("surfaces",), 1280, 1.8, (108, 144, 124, 156), {"SupportAbility": 0.97}
)
LIFE = (
    Change(ChangeKind.SIGHTED, 0.9, None, 0.9, 1.5, 3),
    Change(ChangeKind.OVERLOOKED, 0.55, 0.9, 0.8319327731, 2.0, 4),
    Change(ChangeKind.SIGHTED, 0.7, 0.8319327731, 0.9203263, 9.25, 40),
)


def believed(network: Network, thing: Entity) -> Entity:
    """The thing as the network recognises it."""
    known = network.known(thing.affordances)
    at = (known, thing.size_xyz, thing.top_m, thing.extent_known)
    if thing.region is not None:
        at = (known, (*thing.size_xyz[:2], 0.0), thing.top_m, True)
    return replace(thing, category_belief=network.category_posterior(*at))


def explained_map(folder: Path, kb: AfNet) -> StoredMap:
    """A table with a mug on it in a kitchen, and a table that a chair gives away."""
    network = network_of(kb)
    table = entity("n1", size_xyz=(1.2, 0.8, 0.02), sightings=(TABLE_SEEN,), history=LIFE)
    table = replace(table, existence=folded(LIFE))
    mug = entity(
        "n2",
        position_xyz=(2.1, 1.1, 0.78),
        size_xyz=(0.09, 0.08, 0.1),
        affordances={"ContainAbility": 0.9},
        supported_by="n1",
        existence=0.8,
    )
    predicted = entity(
        "n3",
        NodeKind.CO_OCCURRENCE,
        existence=0.65,
        affordances={"SupportAbility": 1.0},
        predicted_from=("n2",),
        axioms=(kb.iri("LargerSupportNearSeat"),),
        history=(Change(ChangeKind.PREDICTED, 0.65, None, 0.65, 1.5, 0, ("n2",)),),
        extent_known=False,
        region=Region(Relation.NEAR, np.array([[2.0, 1.0, 1.0]]), 0.25, (0.62, 0.84)),
    )
    counts = {"TableHeightSupport": 1, "SmallContainer": 1, "BedSupport": 0}
    sample = sample_map()
    rooms = (
        replace(sample.rooms[0], belief=network.room_posterior(counts), evidence=counts),
        sample.rooms[1],
    )
    things = tuple(believed(network, t) for t in (table, mug, predicted))
    whole = replace(sample, entities=things, rooms=rooms)
    run = {"ontology": ontology_record(kb.files), "parameters": {"rule": "log-odds"}}
    return load(write_map(folder, whole, run, (), kb))
