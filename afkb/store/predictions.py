"""What the scene says of predictions: where the thing may be, and the prediction's life."""

from __future__ import annotations

from pyoxigraph import NamedNode

from afkb.flow import PastPrediction, PredictionState, Region
from afkb.store.evidence import describe_history
from afkb.store.scribe import Scribe, ranked
from afkb.store.vocabulary import term


def describe_life(
    scribe: Scribe,
    node: NamedNode,
    state: PredictionState | None,
    region: Region | None,
) -> None:
    """Of a prediction that still stands: its state, and its region part by part."""
    if state is not None:
        scribe.say(node, "afn:predictionState", term(f"afn:{state.value}"))
    if region is not None:
        _region(scribe, node, region)


def describe_past(scribe: Scribe, past: PastPrediction) -> None:
    """A prediction that came to its end; it is no node of the map's graph."""
    node = scribe.node(past.id)
    scribe.say(node, "rdf:type", term("afn:PastPrediction"))
    scribe.say(node, "afn:predictedAs", term(f"afn:{past.kind}"))
    scribe.say(node, "afn:predictionState", term(f"afn:{past.state.value}"))
    for axis, value in zip("xyz", past.position_xyz, strict=True):
        scribe.say(node, f"afn:{axis}", float(value))
    expected = (scribe.individual(name) for name, _ in ranked(past.affordances))
    scribe.say(node, "afn:expectedAffordance", *expected)
    scribe.probability(node, "afn:probability", past.probability)
    scribe.say(node, "afn:regionRelation", past.relation.value)
    scribe.say(node, "afn:firstSeen", float(past.first_seen))
    scribe.say(node, "afn:lastSeen", float(past.ended))
    scribe.say(node, "afn:predictedFrom", *map(scribe.node, past.predicted_from))
    if past.seen_as is not None:
        scribe.say(node, "afn:confirmedBy", scribe.node(past.seen_as))
    scribe.say(node, "prov:wasGeneratedBy", *scribe.makers([past.generated_by]))
    scribe.say(node, "prov:wasDerivedFrom", *map(scribe.axiom, past.axioms))
    describe_history(scribe, node, past.history)


def _region(scribe: Scribe, node: NamedNode, region: Region) -> None:
    scribe.say(node, "afn:regionRelation", region.relation.value)
    scribe.say(node, "afn:topMin", float(region.tops_m[0]))
    scribe.say(node, "afn:topMax", float(region.tops_m[1]))
    for number, (x, y, share) in enumerate(region.parts, start=1):
        part = NamedNode(f"{node.value}-part-{number}")
        scribe.say(node, "afn:regionPart", part)
        scribe.say(part, "rdf:type", term("afn:RegionPart"))
        scribe.say(part, "afn:x", float(x))
        scribe.say(part, "afn:y", float(y))
        scribe.say(part, "afn:partWidth", float(region.part_m))
        scribe.probability(part, "afn:probability", float(share))
