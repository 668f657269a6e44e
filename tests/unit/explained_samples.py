"""A room whose beliefs are those of the network, written as a map folder."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from afkb.flow import Change, ChangeKind, Entity, NodeKind, Region, Relation, Sighting
from afkb.inference import Network, network_of
from afkb.inference.existence import folded
from afkb.inference.recognition import standing_together
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


def believed(network: Network, things: list[Entity], counts: dict[str, int]) -> list[Entity]:
    """The things as the network recognises them, in a room where that was counted."""
    told = {t.id: t for t in things}
    for together in standing_together(things, lambda _: counts, network):
        shares = network.joint.recognise(together.things, together.room).shares
        for thing, share in zip(together.entities, shares.tolist(), strict=True):
            belief = dict(zip(network.objects.categories, share, strict=True))
            told[thing.id] = replace(thing, category_belief=belief)
    return list(told.values())


def expected(network: Network, thing: Entity) -> Entity:
    """A prediction near something, as the network takes it."""
    at = (network.known(thing.affordances), (*thing.size_xyz[:2], 0.0), thing.top_m)
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
    things = (*believed(network, [table, mug], counts), expected(network, predicted))
    whole = replace(sample, entities=things, rooms=rooms)
    run = {"ontology": ontology_record(kb.files), "parameters": {"rule": "log-odds"}}
    return load(write_map(folder, whole, run, (), kb))
