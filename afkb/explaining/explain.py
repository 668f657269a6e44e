"""The chain behind any node of a map."""

from __future__ import annotations

from dataclasses import replace

from afkb.explaining.explanation import Explanation
from afkb.explaining.naming import node_named
from afkb.explaining.plain import explain_plain
from afkb.explaining.things import (
    ROUNDING,
    explain_prediction,
    explain_room,
    explain_thing,
)
from afkb.inference import network_of
from afkb.knowledge import AfNet
from afkb.store import StoredMap
from afkb.store.made_with import changed_since

PREDICTIONS = ("DualPrediction", "CoOccurrencePrediction", "PastPrediction")


def explain(stored: StoredMap, id_: str, kb: AfNet) -> Explanation:
    """Why a node is in the map and is held for what it is held for, recomputed by `kb`.

    `kb`: the ontology that the map was made with (`afkb.store.made_with.knowledge_of`). Raises
    `MapError` for an id that the map doesn't have.
    """
    node, kind = node_named(stored, id_)
    if kind == "ObservedEntity":
        found = explain_thing(stored, node, network_of(kb))
    elif kind in PREDICTIONS:
        found = explain_prediction(stored, node, kind, network_of(kb))
    elif kind == "Room":
        found = explain_room(stored, node, network_of(kb))
    else:
        return explain_plain(stored, node, kind)
    return replace(found, notes=(*found.notes, *_differences(stored, found, kb)))


def _differences(stored: StoredMap, found: Explanation, kb: AfNet) -> list[str]:
    """What of the chain does not lead to what the map states, and why that may be."""
    notes = [f"{name} has changed since the map was made" for name in changed_since(stored, kb)]
    if found.chain is not None and found.chain.off_by > ROUNDING:
        why = "; its predictor may have said what it would be" if found.kind in PREDICTIONS else ""
        off_by = f"{found.chain.off_by:.2g}"
        notes.append(f"recomputed and stored beliefs differ by up to {off_by}{why}")
    life = found.life
    if life is not None and life.recomputed is not None:
        off = abs(life.recomputed - life.stored)
        if off > ROUNDING:
            notes.append(f"recomputed and stored existence differ by {off:.2g}")
    return notes
