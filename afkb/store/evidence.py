"""What the scene says of what a belief rests on: sightings, and the steps of an existence."""

from __future__ import annotations

from collections.abc import Sequence

from pyoxigraph import Literal, NamedNode

from afkb.flow import Change, Sighting
from afkb.store.scribe import Scribe, ranked
from afkb.store.vocabulary import term


def describe_sightings(scribe: Scribe, node: NamedNode, sightings: Sequence[Sighting]) -> None:
    """The views that showed most of a thing."""
    for number, sighting in enumerate(sightings, start=1):
        _sighting(scribe, node, number, sighting)


def describe_history(scribe: Scribe, node: NamedNode, history: Sequence[Change]) -> None:
    """The steps by which its existence came about, in their order."""
    for number, change in enumerate(history, start=1):
        _change(scribe, node, number, change)


def _sighting(scribe: Scribe, node: NamedNode, number: int, sighting: Sighting) -> None:
    """What one view showed of a thing."""
    seen = NamedNode(f"{node.value}-sighting-{number}")
    scribe.say(node, "afn:sighting", seen)
    scribe.say(seen, "rdf:type", term("afn:Sighting"))
    scribe.say(seen, "afn:viewIndex", sighting.view)
    scribe.say(seen, "afn:stamp", float(sighting.stamp))
    scribe.say(seen, "afn:pixels", sighting.n_pixels)
    scribe.say(seen, "afn:range", float(sighting.range_m))
    if sighting.image_box is not None:
        scribe.say(seen, "afn:imageBox", " ".join(map(str, sighting.image_box)))
    told = (f"{name} {p:.4f}" for name, p in ranked(sighting.affordances))
    scribe.say(seen, "afn:told", ", ".join(told) or None)
    scribe.say(seen, "prov:wasGeneratedBy", *scribe.makers(sighting.detectors))


def _change(scribe: Scribe, node: NamedNode, number: int, change: Change) -> None:
    """One step of its existence."""
    step = NamedNode(f"{node.value}-change-{number}")
    scribe.say(node, "afn:change", step)
    scribe.say(step, "rdf:type", term("afn:Change"))
    scribe.say(step, "afn:changeKind", change.kind.value)
    scribe.say(step, "afn:weighed", Literal(round(float(change.evidence), 9)))
    if change.before is not None:
        scribe.probability(step, "afn:before", change.before)
    scribe.probability(step, "afn:probability", change.after)
    scribe.say(step, "afn:stamp", float(change.stamp))
    scribe.say(step, "afn:viewIndex", change.view)
    scribe.say(step, "afn:byEntity", *map(scribe.node, change.by))
