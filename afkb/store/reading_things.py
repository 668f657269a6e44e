"""Things and predictions read back from RDF, with what their beliefs rest on."""

from __future__ import annotations

import re

import numpy as np

from afkb.flow import (
    Change,
    ChangeKind,
    Entity,
    NodeKind,
    PastPrediction,
    PredictionState,
    Region,
    Relation,
    Sighting,
)
from afkb.store.facts import Thing

_TOLD = re.compile(r"(.+?) (\d\.\d{4})(?:, |$)")
"""A feature with its probability, as `afn:told` lists them."""


def makers(told: Thing) -> tuple[str, ...]:
    """Names of the detectors or predictors behind a thing."""
    names = told.names("prov:wasGeneratedBy")
    return tuple(name.removeprefix("by-") for name in names if name.startswith("by-"))


def entity_of(told: Thing, kind: NodeKind) -> Entity:
    """A thing, observed or predicted."""
    first, outline = told.name("afn:predictedFirst"), told.outline()
    return Entity(
        id=told.id,
        kind=kind,
        position_xyz=_xyz(told),
        size_xyz=(told.number("afn:sizeX"), told.number("afn:sizeY"), told.number("afn:sizeZ")),
        yaw=told.number("afn:yaw"),
        affordances=told.belief("affordance", "affordance"),
        existence=told.number("afn:existence", 1.0),
        category_belief=told.belief("category", "category"),
        movability=told.name("afn:movability") or "Static",
        matching_weight=told.number("afn:matchingWeight", 1.0),
        observations=told.whole("afn:observations"),
        first_seen=told.number("afn:firstSeen"),
        last_seen=told.number("afn:lastSeen"),
        seen_from=told.names("afn:seenFrom"),
        generated_by=makers(told),
        supported_by=told.name("afn:supportedBy"),
        part_of=told.name("afn:partOf"),
        room=told.name("afn:inRoom"),
        predicted_from=told.names("afn:predictedFrom"),
        predicted_first=NodeKind(first) if first else None,
        axioms=_axioms(told),
        extent_known=told.flag("afn:extentKnown"),
        polygon_xy=np.array(outline, dtype=np.float64) if outline else None,
        sightings=tuple(map(_sighting, told.things("afn:sighting"))),
        history=tuple(map(_change, told.things("afn:change"))),
        region=_region(told),
        state=_state(told),
    )


def past_of(told: Thing) -> PastPrediction:
    """A prediction that came to its end; how sure its affordances were is not told any more."""
    return PastPrediction(
        id=told.id,
        kind=told.name("afn:predictedAs") or "",
        state=_state(told) or PredictionState.EXPIRED,
        position_xyz=_xyz(told),
        affordances=dict.fromkeys(told.names("afn:expectedAffordance"), 1.0),
        probability=told.number("afn:probability"),
        relation=Relation(told.name("afn:regionRelation") or ""),
        first_seen=told.number("afn:firstSeen"),
        ended=told.number("afn:lastSeen"),
        history=tuple(map(_change, told.things("afn:change"))),
        generated_by=next(iter(makers(told)), ""),
        predicted_from=told.names("afn:predictedFrom"),
        axioms=_axioms(told),
        seen_as=told.name("afn:confirmedBy"),
    )


def _xyz(told: Thing) -> tuple[float, float, float]:
    return told.number("afn:x"), told.number("afn:y"), told.number("afn:z")


def _state(told: Thing) -> PredictionState | None:
    name = told.name("afn:predictionState")
    return PredictionState(name) if name else None


def _axioms(told: Thing) -> tuple[str, ...]:
    """What it follows from in the ontology: an IRI, or a name where that stands in the scene."""
    anchors = {value.value for value in told.values("afn:predictedFrom")}
    scene = told.iri.rsplit("#", 1)[0] + "#"
    found = [v.value for v in told.values("prov:wasDerivedFrom") if v.value not in anchors]
    return tuple(sorted(told.facts.thing(i).id if i.startswith(scene) else i for i in found))


def _sighting(told: Thing) -> Sighting:
    box = told.name("afn:imageBox")
    u0, v0, u1, v1 = map(int, box.split()) if box else (0, 0, 0, 0)
    return Sighting(
        view=told.whole("afn:viewIndex"),
        stamp=told.number("afn:stamp"),
        detectors=makers(told),
        n_pixels=told.whole("afn:pixels"),
        range_m=told.number("afn:range"),
        image_box=(u0, v0, u1, v1) if box else None,
        affordances={name: float(p) for name, p in _TOLD.findall(told.name("afn:told") or "")},
    )


def _change(told: Thing) -> Change:
    view = told.maybe_number("afn:viewIndex")
    return Change(
        kind=ChangeKind(told.name("afn:changeKind") or ""),
        evidence=told.number("afn:weighed"),
        before=told.maybe_number("afn:before"),
        after=told.number("afn:probability"),
        stamp=told.number("afn:stamp"),
        view=None if view is None else int(view),
        by=told.names("afn:byEntity"),
    )


def _region(told: Thing) -> Region | None:
    parts = told.things("afn:regionPart")
    relation = told.name("afn:regionRelation")
    if relation is None:
        return None
    numbers = [(p.number("afn:x"), p.number("afn:y"), p.number("afn:probability")) for p in parts]
    return Region(
        relation=Relation(relation),
        parts=np.array(numbers, dtype=np.float64).reshape(-1, 3),
        part_m=parts[0].number("afn:partWidth") if parts else 0.0,
        tops_m=(told.number("afn:topMin"), told.number("afn:topMax")),
    )
