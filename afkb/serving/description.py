"""What the endpoint says of itself: SPARQL 1.1 Service Description."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pyoxigraph import BlankNode, Literal, NamedNode, RdfFormat, Triple, serialize

from afkb.serving.forms import GRAPHS

_SD = "http://www.w3.org/ns/sparql-service-description#"
_FORMATS = "http://www.w3.org/ns/formats/"
_TYPE = NamedNode("http://www.w3.org/1999/02/22-rdf-syntax-ns#type")
_FORMAT_NAMES = (
    "SPARQL_Results_JSON", "SPARQL_Results_XML", "SPARQL_Results_CSV", "SPARQL_Results_TSV",
    "Turtle", "N-Triples", "JSON-LD", "RDF_XML",
)  # fmt: skip
"""Names of https://www.w3.org/ns/formats/ for what `answering` writes."""
_PREFIXES = {"sd": _SD, "formats": _FORMATS}


def description(endpoint: str, graphs: Sequence[str], media: str) -> bytes:
    """The description of an endpoint with those named graphs, in a form of `answering.GRAPHS`."""
    form = GRAPHS[media]
    prefixes = _PREFIXES if form == RdfFormat.TURTLE else None
    return serialize(_told(endpoint, graphs), format=form, prefixes=prefixes) or b""


def _told(endpoint: str, graphs: Sequence[str]) -> Iterator[Triple]:
    service, dataset, default = BlankNode("service"), BlankNode("dataset"), BlankNode("default")
    yield Triple(service, _TYPE, _sd("Service"))
    yield Triple(service, _sd("endpoint"), NamedNode(endpoint))
    yield Triple(service, _sd("supportedLanguage"), _sd("SPARQL11Query"))
    yield Triple(service, _sd("feature"), _sd("UnionDefaultGraph"))
    for name in _FORMAT_NAMES:
        yield Triple(service, _sd("resultFormat"), NamedNode(_FORMATS + name))
    yield Triple(service, _sd("defaultDataset"), dataset)
    yield Triple(dataset, _TYPE, _sd("Dataset"))
    yield Triple(dataset, _sd("defaultGraph"), default)
    yield Triple(default, _TYPE, _sd("Graph"))
    for number, graph in enumerate(graphs, start=1):
        named = BlankNode(f"graph{number}")
        yield Triple(dataset, _sd("namedGraph"), named)
        yield Triple(named, _TYPE, _sd("NamedGraph"))
        yield Triple(named, _sd("name"), NamedNode(graph))
    yield Triple(
        service, NamedNode("http://www.w3.org/2000/01/rdf-schema#comment"), Literal(_ABOUT)
    )


_ABOUT = (
    "Maps of what places afford. The default graph is everything together; a map's own graph is "
    "urn:afkb:map:<name of its folder>. Read-only; SERVICE is refused."
)


def _sd(name: str) -> NamedNode:
    return NamedNode(_SD + name)
