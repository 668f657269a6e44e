"""A topological map as RDF, in the vocabulary that DESIGN §7 fixes and docs/reference.md lists."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePath

from pyoxigraph import NamedNode, Triple

from afkb import __version__
from afkb.flow import TopologicalMap
from afkb.store import things
from afkb.store.predictions import describe_past
from afkb.store.rooms import describe_room
from afkb.store.scribe import Names, Scribe
from afkb.store.turtle import fingerprint
from afkb.store.vocabulary import FORMAT_VERSION, SCENES, term

_RUN_FACTS = ("mapper", "rule", "stride", "start", "stop", "seed")


def scene_base(topological_map: TopologicalMap, names: Names) -> str:
    """The namespace of a map's things: named after its content.

    The same map has the same IRIs wherever and whenever it is written; different maps, queried
    together, don't collide.
    """
    return f"{SCENES}{fingerprint(scene_triples(topological_map, SCENES + 'self#', names))}#"


def scene_triples(
    topological_map: TopologicalMap,
    base: str,
    names: Names,
    run: Mapping[str, object] | None = None,
) -> list[Triple]:
    """Every statement about a map; `names` gives the ontology's IRIs, `run` its parameters."""
    scribe = Scribe(base, names)
    _describe_map(scribe, topological_map)
    _describe_run(scribe, topological_map, run or {})
    for place in topological_map.places:
        things.describe_place(scribe, place)
    for entity in topological_map.entities:
        things.describe_entity(scribe, entity)
    for bound in topological_map.bounds:
        things.describe_bound(scribe, bound)
    for doorway in topological_map.doorways:
        things.describe_doorway(scribe, doorway)
    for room in topological_map.rooms:
        describe_room(scribe, room)
    for edge in topological_map.edges:
        things.describe_edge(scribe, edge)
    for number, closure in enumerate(topological_map.closures, start=1):
        things.describe_closure(scribe, number, closure)
    for past in topological_map.past_predictions:
        describe_past(scribe, past)
    accepted = (p for p in topological_map.loops if p.accepted)
    for number, loop in enumerate(accepted, start=1):
        things.describe_correction(scribe, number, loop)
    return scribe.triples


def _describe_map(scribe: Scribe, topological_map: TopologicalMap) -> None:
    whole = scribe.node("map")
    scribe.say(whole, "rdf:type", term("afn:TopologicalMap"))
    scribe.say(whole, "afn:formatVersion", FORMAT_VERSION)
    scribe.say(whole, "prov:wasGeneratedBy", scribe.node("run"))
    scribe.say(whole, "rdfs:comment", *topological_map.notes)
    for name, count in topological_map.counts.items():
        counted = scribe.node(f"count-{name}")
        scribe.say(whole, "afn:count", counted)
        scribe.say(counted, "rdf:type", term("afn:Count"))
        scribe.say(counted, "rdfs:label", name)
        scribe.say(counted, "rdf:value", int(count))


def _describe_run(
    scribe: Scribe, topological_map: TopologicalMap, run: Mapping[str, object]
) -> None:
    """The run and what took part in it; nothing that differs between two runs on one input."""
    activity = scribe.node("run")
    scribe.say(activity, "rdf:type", term("prov:Activity"))
    scribe.say(activity, "rdfs:label", f"afkb {__version__}")
    parameters = run.get("parameters")
    if isinstance(parameters, Mapping):
        for fact in _RUN_FACTS:
            value = parameters.get(fact)
            if isinstance(value, str | int | float):
                scribe.say(activity, f"afn:{fact}", value)
    _describe_ontology(scribe, activity, run.get("ontology"))
    makers = {maker for entity in topological_map.entities for maker in entity.generated_by}
    makers |= {maker for bound in topological_map.bounds for maker in bound.generated_by}
    makers |= {past.generated_by for past in topological_map.past_predictions}
    for maker in sorted(makers):
        part = scribe.node(f"by-{maker}")
        scribe.say(part, "rdf:type", term("prov:Activity"))
        scribe.say(part, "rdfs:label", maker)
        scribe.say(part, "prov:wasInformedBy", activity)


def _describe_ontology(scribe: Scribe, activity: NamedNode, files: object) -> None:
    """The ontology that the run was made with, by what its files say and not where they are."""
    for number, entry in enumerate(files if isinstance(files, list) else [], start=1):
        file = scribe.node(f"ontology-{number}")
        scribe.say(activity, "prov:used", file)
        scribe.say(file, "rdf:type", term("prov:Entity"))
        scribe.say(file, "rdfs:label", PurePath(entry["file"]).name)
        scribe.say(file, "afn:sha256", entry["sha256"])
